/* The step of the march for contacts in space between pads whose modes springs join and a disc that turns, under Coulomb's
   law, each with a linear stiffness of its own, as fast as C goes.

   Modes come as those of the pads, pad by pad, whose matrices are read in their own units; then the cosines and the sines of
   the pairs of the disc, and its others, scaled by the root of their mobility. A contact has three rows, normal and two
   tangents, and `w` is the displacements [c] for a unit of each force [f], `w[f * size + c]`, forces signed (normal,
   -tangential). Contacts are solved in turn from the forces of the step before, along the direction of their friction;
   a direct solve for the normal forces, and for the tangential ones of contacts that stick, follows the first sweeps and changes
   states until none has to. The disc turns by the same angle in each step, whose turns are given. Compiled by brake.py, which
   checks what it computes against the package; places in `carried` have the names of the package's layout.
*/
#include <math.h>
#include <string.h>

#include "elimination.h"
#include "layout.h"

enum { MOST_TRIALS = 100, IN_VAIN = 3, NEWTON = 12, STEPS_OF_YIELDING = 40, SEARCHES = 80 };

/* What a step knows of all contacts; `size` is three times their number. */
typedef struct {
    int count, size;
    const double *w, *opening, *stiffness, *reach, *mu;
    double *carried, *free, *u, *forces, *give, *beyond, *ratio, *kept_forces, *kept_u, *m, *x, *along;
    int *status, *wanted, *kept_status, *may_touch, *broke, *equation;
    double late;
} Contacts;

typedef struct {
    double normal, first, second;
    int status;
} Found;

static inline void displace(const Contacts *at, int i, double more, double pulled, double swerved)
{
    const double *restrict n = at->w + 3 * i * at->size, *restrict a = n + at->size, *restrict b = a + at->size;
    double *restrict u = at->u;
    for (int c = 0; c < at->size; c++)
        u[c] += n[c] * more - a[c] * pulled - b[c] * swerved;
}

/* The nearest of two places of the path after `low`. */
static inline double next_cut(double low, double high, double one)
{
    return low < one && one < high ? one : high;
}

/* Mean of the indentation where it is positive, weighted by a triangle, on the parabola through the last three steps, and
   its slope in the newest. */
static double indented_on_path(double x, double now, double before, double *slope)
{
    static const double nodes[] = {-0.8611363115940526, -0.3399810435848563, 0.3399810435848563, 0.8611363115940526};
    static const double weights[] = {0.3478548451374538, 0.6521451548625461, 0.6521451548625461, 0.3478548451374538};
    const double sloped = 0.5 * (x - before), bent = 0.5 * (x - 2.0 * now + before), least = fmin(fmin(x, now), before);
    double first = 2.0, second = 2.0, mean = 0.0;
    *slope = 0.0;
    if (fmax(fmax(x, now), before) <= 0.0)
        return 0.0;
    if (least > 0.0 && least >= 0.25 * fabs(bent)) {
        *slope = 1.0 / 12.0;
        return (x + 10.0 * now + before) / 12.0;
    }
    const double under = sloped * sloped - 4.0 * bent * now;
    if (bent == 0.0)
        first = sloped != 0.0 ? -now / sloped : 2.0;
    else if (under > 0.0) {
        const double root = -0.5 * (sloped + copysign(sqrt(under), sloped));
        first = root / bent;
        second = root != 0.0 ? now / root : 2.0;
    }
    for (double low = -1.0, high; low < 1.0; low = high) {
        high = next_cut(low, next_cut(low, next_cut(low, 1.0, 0.0), first), second);
        const double middle = 0.5 * (low + high), half = 0.5 * (high - low);
        double piece = 0.0, steeper = 0.0;
        for (int k = 0; k < 4; k++) {
            const double at = middle + half * nodes[k], inside = now + at * (sloped + at * bent);
            const double weight = half * weights[k] * (1.0 - fabs(at));
            if (inside <= 0.0) {
                piece = steeper = 0.0;
                break;
            }
            piece += weight * inside;
            steeper += weight * 0.5 * at * (at + 1.0);
        }
        mean += piece;
        *slope += steeper;
    }
    return mean;
}

/* The same from the quotient of stored energies, which is stable at any step. */
static inline double indented_by_quotient(double x, double before, double *slope)
{
    const double inside = fmax(x, 0.0), was = fmax(before, 0.0), change = x - before;
    double mean = 0.0;
    *slope = 0.0;
    if (inside > 0.0 && was > 0.0) {
        mean = 0.5 * (inside + was);
        *slope = 0.5;
    } else if (change != 0.0) {
        mean = 0.5 * (inside * inside - was * was) / change;
        *slope = (inside - mean) / change;
    }
    if (mean > 0.0)
        return mean;
    *slope = 0.0;
    return 0.0;
}

/* Share of the quotient in the force of a contact that would reach an indentation without force. */
static inline double share_of(double x, const double *c, double steepness)
{
    const double deepest = fmax(x, fmax(-c[LAST_GAP], -c[EARLIER_GAP]));
    return deepest > 0.0 && steepness > 1.0 ? 1.0 - 1.0 / steepness : 0.0;
}

/* How a contact yields about an indentation: more for a unit of force, and beyond that. */
static inline void yield_about(double x, const double *c, double share, double stiffness, double w_nn, double *give,
                               double *beyond)
{
    double slope, steeper;
    double mean = indented_on_path(x, -c[LAST_GAP], -c[EARLIER_GAP], &slope);
    if (share > 0.0) {
        mean += share * (indented_by_quotient(x, -c[EARLIER_GAP], &steeper) - mean);
        slope += share * (steeper - slope);
    }
    *give = 1.0 / fmax(stiffness * slope, 1e-4 / w_nn);
    *beyond = x - *give * stiffness * mean;
}

/* Energy per stiffness stored between two steps, from the indentations at both. */
static inline double stored_between(double x, double now)
{
    return (5.0 * x * now + 0.5 * (x * x + now * now)) / 12.0;
}

/* The contact of one tangent, along a direction of friction: Coulomb's cone, and a slip that comes to its end. */
static inline int solve_along(double gap, double slip, double away, const double *w, double mu, int was, double last,
                              double *normal, double *tangential)
{
    const double stick = slip + away, share = 1.0 / (w[0] * w[3] - w[1] * w[2]);
    int now = 1;
    *normal = (w[1] * stick - w[3] * gap) * share;
    *tangential = (w[0] * stick - w[2] * gap) * share;
    if (fabs(*tangential) > mu * *normal) {
        const double ratio = *tangential < 0.0 ? -mu : mu;
        *normal = -gap / (w[0] - ratio * w[1]);
        *tangential = ratio * *normal;
        now = 2;
    }
    if (was == 2 && last != 0.0 && (now == 1 || *tangential * last < 0.0)) {
        const double ratio = last < 0.0 ? -mu : mu, free_on = w[0] - ratio * w[1], free_back = w[0] + ratio * w[1];
        const double on = -gap / free_on, farther = slip + (w[2] - ratio * w[3]) * on;
        if (free_on > 0.0 && free_back > 0.0 && farther * last < 0.0) {
            const double left = last / (last - farther), undone = slip - last;
            double pressed = (w[1] * undone - w[3] * gap) * share, needed = (w[0] * undone - w[2] * gap) * share;
            now = 1;
            if (fabs(needed) > mu * pressed) {
                pressed = -gap / free_back;
                needed = -ratio * pressed;
                now = 2;
            }
            *normal = left * on + (1.0 - left) * pressed;
            *tangential = left * ratio * on + (1.0 - left) * needed;
        }
    }
    return now;
}

static inline void turned(const double *w, double c, double s, double *out)
{
    out[0] = w[0];
    out[1] = c * w[1] + s * w[2];
    out[2] = c * w[3] + s * w[6];
    out[3] = c * (c * w[4] + s * w[5]) + s * (c * w[7] + s * w[8]);
}

/* Of a contact in space: what it is without its own forces, what it was, and the forces that it had last. */
typedef struct {
    double gap, slips[2], away[2], w[9], mu, last[2], earlier[2], guess[2];
    int was;
} Alone;

static int along_direction(const Alone *one, double c, double s, int was, double *normal, double *tangential)
{
    double w[4];
    turned(one->w, c, s, w);
    return solve_along(one->gap, c * one->slips[0] + s * one->slips[1], c * one->away[0] + s * one->away[1], w, one->mu, was,
                       c * one->last[0] + s * one->last[1], normal, tangential);
}

static inline void slips_under(const Alone *one, double c, double s, double normal, double tangential, double *slip,
                               double *swerve)
{
    const double *w = one->w;
    *slip = one->slips[0] + w[3] * normal - (c * w[4] + s * w[5]) * tangential;
    *swerve = one->slips[1] + w[6] * normal - (c * w[7] + s * w[8]) * tangential;
}

/* Share of the last two slips in the velocity along which friction acts; none late, or where a slip begins against them. */
static inline void carry_on(const Alone *one, double late, double c, double s, double *carried_on)
{
    for (int k = 0; k < 2; k++)
        carried_on[k] = 6.0 * one->last[k] + one->earlier[k];
    if (late > 0.0 || (one->was < 2 && c * carried_on[0] + s * carried_on[1] <= 0.0))
        carried_on[0] = carried_on[1] = 0.0;
}

/* Whether friction along the last slip, of a size and a direction, reverses it with only rounding across. */
static int turns_on_its_line(const Alone *one, double size, double c, double s)
{
    const double *w = one->w, clear = w[0] - one->mu * (c * w[1] + s * w[2]);
    if (size == 0.0 || clear <= 0.0)
        return 0;
    const double normal = -one->gap / clear;
    double slip, swerve;
    slips_under(one, c, s, normal, one->mu * normal, &slip, &swerve);
    const double farther = c * slip + s * swerve, across = c * swerve - s * slip;
    return farther < 0.0 && fabs(across) <= 1e-6 * (size - farther);
}

/* The direction of friction of a contact that slides, by Newton's method; whether it is found. */
static int slides_along(const Alone *one, const double *carried_on, double *c_found, double *s_found)
{
    const double *w = one->w, mu = one->mu;
    double c = *c_found, s = *s_found;
    for (int k = 0; k < NEWTON; k++) {
        const double free = w[0] - mu * (c * w[1] + s * w[2]);
        if (!(free > 0.0))
            break;
        const double normal = -one->gap / free, turning = normal * mu * (c * w[2] - s * w[1]) / free;
        const double pulled = mu * normal, more = mu * turning;
        const double first = c * w[4] + s * w[5], second = c * w[7] + s * w[8];
        const double moved = 9.0 * (one->slips[0] + w[3] * normal - first * pulled) + carried_on[0];
        const double swerved = 9.0 * (one->slips[1] + w[6] * normal - second * pulled) + carried_on[1];
        const double moving = 9.0 * (w[3] * turning - first * more - (c * w[5] - s * w[4]) * pulled);
        const double swerving = 9.0 * (w[6] * turning - second * more - (c * w[8] - s * w[7]) * pulled);
        const double slope = c * swerving - s * moving - (c * moved + s * swerved);
        if (!(slope < 0.0))
            break;
        const double change = -(c * swerved - s * moved) / slope;
        if (!(fabs(change) < 1.0))
            break;
        const double further = c - s * change;
        s += c * change;
        c = further;
        const double size = sqrt(c * c + s * s);
        c /= size;
        s /= size;
        if (fabs(change) < 1e-7) {
            *c_found = c;
            *s_found = s;
            return 1;
        }
    }
    *c_found = c;
    *s_found = s;
    return 0;
}

/* The same by the secant method within a bracket, where Newton's finds none, or where the contact may stick. */
static int searched(const Alone *one, int may_hold, double late, double *c_found, double *s_found, double *normal,
                    double *tangential)
{
    const double first = *c_found, second = *s_found, *w = one->w;
    double carried_on[2];
    carry_on(one, late, first, second, carried_on);
    double turn = 0.0, low = -1e300, high = 1e300, turn_before = 0.0, across_before = 0.0, c = first, s = second;
    int status = 0, was = late > 0.0 ? 0 : one->was;
    for (int trial = 0; trial < SEARCHES; trial++) {
        c = first * cos(turn) - second * sin(turn);
        s = second * cos(turn) + first * sin(turn);
        status = along_direction(one, c, s, was, normal, tangential);
        if (may_hold && one->was == 1)
            was = 0;
        if (trial == 0 && may_hold && status == 1)
            break;
        double slip, swerve;
        slips_under(one, c, s, *normal, *tangential, &slip, &swerve);
        const double moved = 9.0 * slip + carried_on[0], swerved = 9.0 * swerve + carried_on[1];
        const double across = c * swerved - s * moved;
        const double size = fabs(one->slips[0]) + fabs(one->slips[1]) + (fabs(w[3]) + fabs(w[6])) * *normal
                            + (w[4] + w[8]) * fabs(*tangential);
        if (fabs(across) <= 1e-12 * (9.0 * size + fabs(carried_on[0]) + fabs(carried_on[1])))
            break;
        const double side = *tangential >= 0.0 ? across : -across;
        if (side > 0.0)
            low = fmax(low, turn);
        else
            high = fmin(high, turn);
        const double soft = s * (s * w[4] - c * w[5]) + c * (c * w[8] - s * w[7]);
        const double stiff = fabs(c * moved + s * swerved) + 9.0 * fabs(*tangential) * soft;
        double change = stiff > 0.0 ? side / stiff : 1e300;
        if (trial && turn != turn_before && fabs(across) < 0.5 * fabs(across_before))
            change = across * (turn - turn_before) / (across_before - across);
        turn_before = turn;
        across_before = across;
        double found = turn + fmin(fmax(change, -1.0), 1.0);
        if (!(low < found && found < high))
            found = low > -1e299 && high < 1e299 ? 0.5 * (low + high) : turn + copysign(0.5, side);
        if (found == turn || !(low < found && found < high))
            break;
        turn = found;
    }
    *c_found = c;
    *s_found = s;
    return status;
}

static Found solve_in_space(const Alone *one, double late)
{
    const double *w = one->w, gap = one->gap, mu = one->mu;
    if (gap >= 0.0)
        return (Found){0.0, 0.0, 0.0, 0};
    double c = 1.0, s = 0.0, held = 0.0, slip, swerve, normal, tangential;
    {
        const double p = w[4] - w[3] * w[1] / w[0], q = w[5] - w[3] * w[2] / w[0], r = w[7] - w[6] * w[1] / w[0];
        const double t = w[8] - w[6] * w[2] / w[0], determinant = p * t - q * r;
        double first = one->slips[0] + one->away[0] - w[3] * gap / w[0];
        double second = one->slips[1] + one->away[1] - w[6] * gap / w[0];
        if (fabs(determinant) > 1e-12 * (p + t) * (p + t)) {
            const double solved = (t * first - q * second) / determinant;
            second = (p * second - r * first) / determinant;
            first = solved;
        }
        const double size = sqrt(first * first + second * second), pressed = w[1] * first + w[2] * second - gap;
        if (size > 0.0) {
            c = first / size;
            s = second / size;
            held = pressed > 0.0 ? size * w[0] / pressed : 1e300;
        }
    }
    const int may_hold = held <= mu || mu == 0.0;
    if (!may_hold) {
        const double size = sqrt(one->guess[0] * one->guess[0] + one->guess[1] * one->guess[1]);
        double near = size > 0.0 ? one->guess[0] / size : c, nearly = size > 0.0 ? one->guess[1] / size : s, carried_on[2];
        carry_on(one, late, c, s, carried_on);
        if (slides_along(one, carried_on, &near, &nearly)) {
            normal = -gap / (w[0] - mu * (near * w[1] + nearly * w[2]));
            slips_under(one, near, nearly, normal, mu * normal, &slip, &swerve);
            const int turns = late == 0.0 && near * one->last[0] + nearly * one->last[1] < 0.0;
            if (one->was < 2 || (near * slip + nearly * swerve >= 0.0 && !turns))
                return (Found){normal, mu * normal * near, mu * normal * nearly, 2};
            c = near;
            s = nearly;
        }
    }
    const double size = sqrt(one->last[0] * one->last[0] + one->last[1] * one->last[1]);
    const double along = size > 0.0 ? one->last[0] / size : 1.0, across = size > 0.0 ? one->last[1] / size : 0.0;
    const int slid = one->was == 2 && late == 0.0;
    if (slid && turns_on_its_line(one, size, along, across)) {
        const int status = along_direction(one, along, across, one->was, &normal, &tangential);
        return (Found){normal, tangential * along, tangential * across, status};
    }
    int status = searched(one, may_hold, late, &c, &s, &normal, &tangential);
    if (slid && status == 2 && size > 0.0) {
        slips_under(one, c, s, normal, tangential, &slip, &swerve);
        if (tangential * (c * slip + s * swerve) < 0.0) {
            c = along;
            s = across;
            status = along_direction(one, c, s, one->was, &normal, &tangential);
        }
    }
    return (Found){normal, tangential * c, tangential * s, status};
}

/* Columns along both tangents. */
static const int MATERIALS[2] = {MATERIAL, MATERIAL_B}, ANCHORS[2] = {ANCHOR, ANCHOR_B};
static const int LAST_SLIPS[2] = {LAST_SLIP, LAST_SLIP_B}, EARLIER_SLIPS[2] = {EARLIER_SLIP, EARLIER_SLIP_B};
static const int PULLS[2] = {LAST_TANGENTIAL, LAST_TANGENTIAL_B};

static inline double strayed(const double *c, int k)
{
    return c[STATUS] == 1.0 ? c[MATERIALS[k]] - c[ANCHORS[k]] : 0.0;
}

/* Solve contact i with the others as they are, as it yields: Newton's method for its indentation. */
static Found solve_one(Contacts *at, int i)
{
    const double *c = at->carried + CARRIED * i, *f = at->forces + 3 * i, *u = at->u + 3 * i;
    const int size = at->size;
    const double late = at->late > 0.0 ? (at->broke[i] > 1 ? 1.0 : 0.25) : 0.0;
    Alone one = {.mu = at->mu[i], .was = (int)c[STATUS], .last = {c[LAST_SLIP], c[LAST_SLIP_B]},
                 .earlier = {c[EARLIER_SLIP], c[EARLIER_SLIP_B]}, .away = {strayed(c, 0), strayed(c, 1)},
                 .guess = {f[1], f[2]}};
    for (int r = 0; r < 3; r++)
        for (int k = 0; k < 3; k++)
            one.w[3 * r + k] = at->w[(3 * i + k) * size + 3 * i + r];
    const double *w = one.w, gap = u[0] - w[0] * f[0] + w[1] * f[1] + w[2] * f[2], w_nn = w[0];
    for (int k = 0; k < 2; k++)
        one.slips[k] = u[1 + k] - w[3 + 3 * k] * f[0] + w[4 + 3 * k] * f[1] + w[5 + 3 * k] * f[2];
    const double share = share_of(-gap, c, at->reach[i] * at->stiffness[i]);
    double give, beyond;
    Found found;
    yield_about(-gap, c, share, at->stiffness[i], w_nn, &give, &beyond);
    for (int k = 0; k < STEPS_OF_YIELDING; k++) {
        one.gap = gap + beyond;
        one.w[0] = w_nn + give;
        found = solve_in_space(&one, late);
        at->give[i] = give;
        at->beyond[i] = beyond;
        const double reached = -(gap + w_nn * found.normal - w[1] * found.first - w[2] * found.second);
        yield_about(reached, c, share, at->stiffness[i], w_nn, &give, &beyond);
        if (fabs(reached - beyond - give * found.normal) * w_nn / (w_nn + give) <= 1e-14 * (fabs(reached) + fabs(gap)))
            break;
    }
    return found;
}

/* Put the system of all contacts in their states: unknown are normal forces, and tangential ones of those that stick. */
static int put_system(Contacts *at)
{
    const int size = at->size, count = at->count;
    int places[size], equations = 0;
    for (int i = 0; i < count; i++) {
        at->equation[i] = equations;
        if (at->status[i])
            places[equations++] = 3 * i;
        for (int k = 1; k < 3 && at->status[i] == 1; k++) {
            at->ratio[2 * i + k - 1] = 0.0;
            places[equations++] = 3 * i + k;
        }
    }
    for (int i = 0; i < count; i++) {
        if (!at->status[i])
            continue;
        const double *restrict n = at->w + 3 * i * size, *restrict a = n + size, *restrict b = a + size;
        const double *c = at->carried + CARRIED * i;
        double *restrict along = at->along;
        int e = at->equation[i];
        for (int k = 0; k < size; k++)
            along[k] = n[k] - at->ratio[2 * i] * a[k] - at->ratio[2 * i + 1] * b[k];
        /* Column by column: `m` is the matrix transposed, eliminated from the right. */
        for (int r = 0; r < equations; r++)
            at->m[e * size + r] = along[places[r]];
        at->m[e * size + e] += at->give[i];
        at->x[e] = -at->free[3 * i] - at->beyond[i];
        for (int k = 0; k < 2 && at->status[i] == 1; k++) {
            const double *restrict column = k ? b : a;
            for (int r = 0; r < equations; r++)
                at->m[(e + 1 + k) * size + r] = column[places[r]];
            at->x[e + 1 + k] = -at->free[3 * i + 1 + k] - strayed(c, k);
        }
    }
    return equations;
}

static inline double velocity(const Contacts *at, int i, int k)
{
    const double *c = at->carried + CARRIED * i;
    return 9.0 * at->u[3 * i + 1 + k] + (at->late > 0.0 ? 0.0 : 6.0 * c[LAST_SLIPS[k]] + c[EARLIER_SLIPS[k]]);
}

/* Put which state each contact wants; return how many want another, and the last of them. */
static int compare(Contacts *at, double slack, int *last)
{
    int odd = 0;
    for (int i = 0; i < at->count; i++) {
        const double *f = at->forces + 3 * i, most = (1.0 + 1e-9) * at->mu[i] * f[0];
        int wanted = at->status[i];
        if (!wanted)
            wanted = at->u[3 * i] < -slack ? 2 : 0;
        else if (f[0] < 0.0)
            wanted = 0;
        else if (wanted == 1 && f[1] * f[1] + f[2] * f[2] > most * most)
            wanted = 2;
        else if (wanted == 2 && !(at->late > 0.0 && at->broke[i] > 1)
                 && f[1] * velocity(at, i, 0) + f[2] * velocity(at, i, 1) < 0.0)
            wanted = 1;
        at->wanted[i] = wanted;
        if (wanted != at->status[i]) {
            odd++;
            *last = i;
        }
    }
    return odd;
}

static void change_state(Contacts *at, int i)
{
    const int was = at->status[i], now = at->wanted[i];
    double *f = at->forces + 3 * i;
    if (now == was)
        return;
    if (now == 2) {
        /* One that closes slides the way that it moves, one that breaks away as it was pulled. */
        const double first = was ? f[1] : velocity(at, i, 0), second = was ? f[2] : velocity(at, i, 1);
        const double size = sqrt(first * first + second * second);
        at->ratio[2 * i] = at->mu[i] * (size > 0.0 ? first / size : 1.0);
        at->ratio[2 * i + 1] = at->mu[i] * (size > 0.0 ? second / size : 0.0);
        at->broke[i] |= 1;
    } else
        at->ratio[2 * i] = at->ratio[2 * i + 1] = 0.0;
    at->status[i] = now;
    if (!was) {
        at->may_touch[i] = 1;
        const double *c = at->carried + CARRIED * i, indented = -at->u[3 * i];
        yield_about(indented, c, share_of(indented, c, at->reach[i] * at->stiffness[i]), at->stiffness[i],
                    at->w[3 * i * at->size + 3 * i], at->give + i, at->beyond + i);
    }
    if (!now) {
        displace(at, i, -f[0], -f[1], -f[2]);
        f[0] = f[1] = f[2] = 0.0;
    }
}

/* The forces of all contacts from their states, which change until none has to; whether that is given up. */
static int solve_states(Contacts *at)
{
    const int size = at->size, count = at->count;
    double slack = 0.0;
    memcpy(at->kept_forces, at->forces, size * sizeof(double));
    memcpy(at->kept_u, at->u, size * sizeof(double));
    memcpy(at->kept_status, at->status, count * sizeof(int));
    for (int k = 0; k < size; k++)
        slack = fmax(slack, fabs(at->free[k]));
    slack *= 1e-12;
    for (int i = 0; i < count; i++)
        for (int k = 0; k < 2; k++)
            at->ratio[2 * i + k] = at->forces[3 * i] > 0.0 ? at->forces[3 * i + 1 + k] / at->forces[3 * i] : 0.0;
    int fewest = count + 1, vain = 0;
    for (int trial = 0; trial < MOST_TRIALS; trial++) {
        const int equations = put_system(at);
        if (!eliminate(at->m, at->x, equations, size))
            break;
        for (int i = 0; i < count; i++) {
            if (!at->status[i])
                continue;
            double *f = at->forces + 3 * i, found[3];
            const int e = at->equation[i];
            found[0] = at->x[e];
            for (int k = 0; k < 2; k++)
                found[1 + k] = at->status[i] == 1 ? -at->x[e + 1 + k] : at->ratio[2 * i + k] * found[0];
            displace(at, i, found[0] - f[0], found[1] - f[1], found[2] - f[2]);
            memcpy(f, found, sizeof found);
        }
        int last = -1;
        const int odd = compare(at, slack, &last);
        if (!odd)
            return 0;
        vain = odd < fewest ? 0 : vain + 1;
        if (odd < fewest)
            fewest = odd;
        for (int i = 0; i < count; i++)
            if (vain <= IN_VAIN || i == last)
                change_state(at, i);
    }
    memcpy(at->forces, at->kept_forces, size * sizeof(double));
    memcpy(at->u, at->kept_u, size * sizeof(double));
    memcpy(at->status, at->kept_status, count * sizeof(int));
    return 1;
}

/* Sweeps and direct solves until no force changes; returns the sweeps made. */
static int solve_all(Contacts *at, double tolerance, int most_sweeps)
{
    double before = INFINITY, rounding = 0.0;
    int given_up = 0, sweep;
    for (int i = 0; i < at->count; i++)
        for (int k = 0; k < 2; k++)
            rounding = fmax(rounding, 1e-15 * fabs(at->carried[CARRIED * i + MATERIALS[k]]));
    at->late = 0.0;
    for (sweep = 1; sweep <= most_sweeps; sweep++) {
        double change = 0.0, largest = 0.0, misfit = 0.0, reach = 0.0;
        int settled = 1;
        for (int i = 0; i < at->count; i++) {
            at->may_touch[i] |= at->u[3 * i] < 0.0;
            if (!at->may_touch[i])
                continue;
            const Found found = solve_one(at, i);
            double *f = at->forces + 3 * i;
            const double more = found.normal - f[0], pulled = found.first - f[1], swerved = found.second - f[2];
            const double *n = at->w + 3 * i * at->size + 3 * i, *a = n + at->size, *b = a + at->size;
            settled &= found.status == at->status[i];
            at->status[i] = found.status;
            at->broke[i] |= found.status == 2;
            displace(at, i, more, pulled, swerved);
            f[0] = found.normal;
            f[1] = found.first;
            f[2] = found.second;
            change = fmax(fmax(change, fabs(more)), fmax(fabs(pulled), fabs(swerved)));
            largest = fmax(fmax(largest, found.normal), fabs(found.first));
            misfit = fmax(misfit, fmax(fabs(n[0] * more - a[0] * pulled), fabs(n[1] * more - a[1] * pulled)));
            misfit = fmax(misfit, fabs(b[2] * swerved));
            reach = fmax(reach, n[0] * found.normal);
        }
        double error = INFINITY;
        if (change <= 1e-14 * largest)
            break;
        if (change < before && before < 1e300)
            error = change / (largest > 0.0 ? largest : 1.0) * fmax(change / (before - change), 0.1);
        if (misfit <= 0.01 * tolerance * reach + rounding)
            error = reach > 0.0 ? misfit / reach : 0.0;
        if (error <= tolerance)
            break;
        before = change;
        const int early = sweep <= SWEEPS_PER_DIRECT_SOLVE;
        if (early ? !given_up || settled : sweep % SWEEPS_PER_DIRECT_SOLVE == 0 && sweep <= PATIENCE && settled) {
            given_up = solve_states(at);
            if (sweep == 1 || !early)
                before = INFINITY;
        }
        if (sweep == PATIENCE) {
            at->late = 1.0;
            for (int i = 0; i < at->count; i++)
                at->broke[i] = at->broke[i] ? 2 : 0;
        }
    }
    return sweep;
}

/* The modes of the disc before a step: what turning does to the contacts, with which their anchors are carried along. */
static void turn(int pairs, const double *restrict turns, double *restrict q, double *restrict d, double *restrict risen,
                 double *restrict advanced, double *restrict passed)
{
    const double *restrict v = turns, *restrict s = v + pairs, *restrict rv = s + pairs, *restrict rs = rv + pairs;
    const double *restrict bv = rs + pairs, *restrict bs = bv + pairs;
    for (int k = 0; k < pairs; k++) {
        const double a = q[k], b = q[pairs + k], c = d[k], e = d[pairs + k], x = a - c, y = b - e;
        const double along = -v[k] * c - s[k] * e, across = s[k] * c - v[k] * e;
        risen[k] = -s[k] * y;
        risen[pairs + k] = s[k] * x;
        advanced[k] = 0.5 * ((rv[k] - v[k]) * a + (rs[k] - s[k]) * b + bv[k] * x + bs[k] * y - along);
        advanced[pairs + k] = 0.5 * ((rv[k] - v[k]) * b - (rs[k] - s[k]) * a + bv[k] * y - bs[k] * x - across);
        passed[k] = -rv[k] * a - rs[k] * b;
        passed[pairs + k] = rs[k] * a - rv[k] * b;
        q[k] = a - v[k] * a - s[k] * b;
        q[pairs + k] = b + s[k] * a - v[k] * b;
        d[k] = c + along;
        d[pairs + k] = e + across;
    }
}

static inline double product(const double *restrict a, const double *restrict b, int size)
{
    double sum = 0.0;
    for (int k = 0; k < size; k++)
        sum += a[k] * b[k];
    return sum;
}

void march(long first_step, long steps, int modes, int pads, int pad, int pairs, int count, double tolerance, int most_sweeps,
           const double *restrict kept, const double *restrict stiffness, const double *restrict load,
           const double *restrict matrices, const double *restrict turns, const double *restrict rows, const double *restrict w,
           const double *restrict opening, const double *restrict yields, const double *restrict reaches,
           const double *restrict mu, const double *restrict belts, double *restrict q, double *restrict d,
           double *restrict carried, double *restrict ledger, double *restrict sums, double *restrict scratch)
{
    const int size = 3 * count, coupled = pads * pad, rest = modes - coupled, each = pad * pad, facing = count / pads;
    double *restrict increment = scratch, *restrict position = increment + modes, *restrict push = position + modes;
    double *restrict both = push + modes, *restrict risen = both + modes, *restrict advanced = risen + 2 * pairs;
    double *restrict passed = advanced + 2 * pairs, *restrict turning = passed + 2 * pairs, *restrict own = turning + size;
    int status[count], wanted[count], kept_status[count], may_touch[count], broke[count], equation[count];
    Contacts at = {.count = count, .size = size, .w = w, .opening = opening, .stiffness = yields, .reach = reaches,
                   .mu = mu, .carried = carried, .free = own, .u = own + size, .forces = own + 2 * size,
                   .kept_forces = own + 3 * size, .kept_u = own + 4 * size, .x = own + 5 * size, .along = own + 6 * size, .give = own + 7 * size,
                   .beyond = own + 8 * size, .ratio = own + 9 * size, .m = own + 10 * size, .status = status,
                   .wanted = wanted, .kept_status = kept_status, .may_touch = may_touch, .broke = broke,
                   .equation = equation};
    for (long n = first_step; n < first_step + steps; n++) {
        turn(pairs, turns, q + coupled, d + coupled, risen, advanced, passed);
        for (int p = 0; p < pads; p++) {
            const double *restrict a = matrices + 4 * p * each, *restrict b = a + each;
            const double *restrict x = q + p * pad, *restrict y = d + p * pad;
            for (int k = 0; k < pad; k++) {
                double sum = 0.0;
                for (int j = 0; j < pad; j++)
                    sum += a[k * pad + j] * y[j] - b[k * pad + j] * x[j];
                increment[p * pad + k] = load[p * pad + k] + sum;
            }
        }
        for (int k = coupled; k < modes; k++)
            increment[k] = kept[k] * d[k] - stiffness[k] * q[k] + load[k];
        for (int k = 0; k < modes; k++)
            position[k] = q[k] + increment[k];
        int touching = 0;
        for (int i = 0; i < count; i++) {
            double *c = carried + CARRIED * i;
            const int first = i / facing * pad;
            for (int k = 0; k < 3; k++) {
                const double *row = rows + (3 * i + k) * modes;
                at.free[3 * i + k] = product(row + first, position + first, pad)
                                     + product(row + coupled, position + coupled, rest);
                turning[3 * i + k] = product(row + coupled, k ? advanced : risen, 2 * pairs);
            }
            at.free[3 * i] += opening[i];
            for (int k = 0; k < 2; k++) {
                const double met = product(rows + (3 * i + 1 + k) * modes + coupled, passed, 2 * pairs);
                c[MATERIALS[k]] += met;
                c[ANCHORS[k]] += met;
                at.free[3 * i + 1 + k] -= belts[2 * i + k] * (n + 1) + c[MATERIALS[k]];
            }
            may_touch[i] = at.free[3 * i] < 0.0 || c[LAST_GAP] < 0.0 || c[EARLIER_GAP] < 0.0;
            touching |= may_touch[i];
        }
        memcpy(at.u, at.free, size * sizeof(double));
        for (int i = 0; i < count; i++) {
            const double *c = carried + CARRIED * i;
            const int closed = touching && c[STATUS] > 0.5;
            double *f = at.forces + 3 * i;
            f[0] = closed ? c[LAST_NORMAL] : 0.0;
            f[1] = closed ? c[LAST_TANGENTIAL] : 0.0;
            f[2] = closed ? c[LAST_TANGENTIAL_B] : 0.0;
            status[i] = f[0] > 0.0 ? (int)c[STATUS] : 0;
            may_touch[i] |= f[0] > 0.0;
            broke[i] = 0;
            at.give[i] = at.beyond[i] = 0.0;
            if (f[0] > 0.0)
                displace(&at, i, f[0], f[1], f[2]);
        }
        if (touching)
            sums[0] += solve_all(&at, tolerance, most_sweeps);
        memset(push, 0, modes * sizeof *push);
        for (int i = 0; i < count; i++)
            if (status[i]) {
                const double *restrict a = rows + 3 * i * modes, *restrict b = a + modes, *restrict c = b + modes;
                const double *f = at.forces + 3 * i;
                for (int k = i / facing * pad, end = k + pad; k < end; k++)
                    push[k] += a[k] * f[0] - b[k] * f[1] - c[k] * f[2];
                for (int k = coupled; k < modes; k++)
                    push[k] += a[k] * f[0] - b[k] * f[1] - c[k] * f[2];
            }
        double exchanged = 0.0, lost = 0.0;
        for (int p = 0; p < pads; p++) {
            const double *restrict mobility = matrices + (4 * p + 2) * each, *restrict loss = mobility + each;
            for (int k = 0; k < pad; k++)
                increment[p * pad + k] += product(mobility + k * pad, push + p * pad, pad);
            for (int k = p * pad; k < (p + 1) * pad; k++)
                both[k] = increment[k] + d[k];
            for (int k = 0; k < pad; k++)
                lost += both[p * pad + k] * product(loss + k * pad, both + p * pad, pad);
        }
        for (int k = 0; k < coupled; k++) {
            exchanged += push[k] * both[k];
            q[k] += increment[k];
            d[k] = increment[k];
        }
        double taken = 0.0;
        for (int k = coupled; k < modes; k++) {
            const double step = increment[k] + push[k], sum = step + d[k];
            exchanged += push[k] * sum;
            taken += (1.0 - kept[k]) * sum * sum;
            q[k] += step;
            d[k] = step;
        }
        ledger[DAMPING_LOSS] += lost + 0.25 * taken;
        double work = 0.5 * exchanged, driven = 0.0;
        for (int i = 0; i < count; i++) {
            double *c = carried + CARRIED * i;
            const double *f = at.forces + 3 * i, *u = at.u + 3 * i, *by = turning + 3 * i;
            const double earlier = fmax(-c[EARLIER_GAP], 0.0), last = fmax(-c[LAST_GAP], 0.0), now = fmax(-u[0], 0.0);
            const double size_of = sqrt(f[1] * f[1] + f[2] * f[2]);
            work += yields[i] * (stored_between(now, last) - stored_between(last, earlier));
            driven += f[1] * (by[1] - belts[2 * i]) + f[2] * (by[2] - belts[2 * i + 1]) - f[0] * by[0];
            if (size_of > 0.0)
                ledger[FRICTION_LOSS] += fabs(f[1] * u[1] + f[2] * u[2]);
            sums[1] += f[0];
            sums[2] += f[1];
            sums[3] += f[2];
            sums[4 + status[i]] += 1.0;
            for (int k = 0; k < 2; k++) {
                if (status[i] == 1 && c[STATUS] != 1.0)
                    c[ANCHORS[k]] = c[MATERIALS[k]];
                c[MATERIALS[k]] += u[1 + k];
                c[EARLIER_SLIPS[k]] = c[LAST_SLIPS[k]];
                c[LAST_SLIPS[k]] = u[1 + k];
                c[PULLS[k]] = f[1 + k];
            }
            c[LAST_NORMAL] = f[0];
            c[STATUS] = status[i];
            c[EARLIEST_GAP] = c[EARLIER_GAP];
            c[EARLIER_GAP] = c[LAST_GAP];
            c[LAST_GAP] = u[0];
        }
        ledger[CONTACT_WORK] += work - driven;
        ledger[DRIVE_WORK] += driven;
    }
}
