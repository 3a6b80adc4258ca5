/* The step of the march for any number of planar contacts of one body on a rigid belt under Coulomb's law, as fast as C goes.

   Modes are scaled by the root of their mobility. `rows` has for each contact its displacement along normal and tangent for a
   unit of each mode, `w` is rows times rows transposed: the displacements for unit forces, signed (normal, -tangential). The
   contacts are solved in turn from the forces of the step before, displacements carried along; states that have settled are
   solved for directly. Compiled by many_contacts.py, which checks what it computes against the package; places in `carried` have
   the names of the package's layout.
*/
#include <math.h>
#include <string.h>

#include "elimination.h"
#include "layout.h"

static void displace(int size, const double *restrict w, double *restrict u, int i, double normal, double tangential)
{
    const double *restrict a = w + 2 * i * size, *restrict b = a + size;
    for (int c = 0; c < size; c++)
        u[c] += a[c] * normal - b[c] * tangential;
}

/* The forces of the states found, ratios of sliding kept; nothing where these admit none. Unknown are the normal forces of
   contacts that are closed, and the tangential ones of those that stick; column by column, as `w` has them. */
static void solve_states(int count, const double *restrict w, const double *restrict gaps, const double *restrict slips,
                         const double *restrict away, double *restrict u, double *restrict forces, const int *status,
                         double *restrict m, double *restrict x)
{
    const int size = 2 * count;
    int places[size], first[count], equations = 0;
    for (int i = 0; i < count; i++) {
        first[i] = equations;
        if (status[i])
            places[equations++] = 2 * i;
        if (status[i] == 1)
            places[equations++] = 2 * i + 1;
    }
    for (int i = 0; i < count; i++) {
        if (!status[i])
            continue;
        const double *restrict a = w + 2 * i * size, *restrict b = a + size;
        double *restrict column = m + first[i] * size;
        const double ratio = status[i] == 2 && forces[2 * i] > 0.0 ? forces[2 * i + 1] / forces[2 * i] : 0.0;
        for (int r = 0; r < equations; r++)
            column[r] = a[places[r]] - ratio * b[places[r]];
        x[first[i]] = -gaps[i];
        if (status[i] == 1) {
            for (int r = 0; r < equations; r++)
                column[size + r] = b[places[r]];
            x[first[i] + 1] = -slips[i] - away[i];
        }
    }
    if (!eliminate(m, x, equations, size))
        return;
    for (int i = 0; i < count; i++)
        if (status[i] && x[first[i]] < 0.0)
            return;
    for (int i = 0; i < count; i++) {
        if (!status[i])
            continue;
        const double normal = x[first[i]], was = forces[2 * i], ratio = was > 0.0 ? forces[2 * i + 1] / was : 0.0;
        const double tangential = status[i] == 1 ? -x[first[i] + 1] : ratio * normal;
        displace(size, w, u, i, normal - was, tangential - forces[2 * i + 1]);
        forces[2 * i] = normal;
        forces[2 * i + 1] = tangential;
    }
}

void march(long steps, int modes, int count, double mu, double tolerance, int most_sweeps, double belt,
           const double *restrict kept, const double *restrict stiffness, const double *restrict load,
           const double *restrict rows, const double *restrict w, const double *restrict opening, double *restrict q,
           double *restrict d, double *restrict carried, double *restrict ledger, double *restrict sums,
           double *restrict scratch)
{
    const int size = 2 * count;
    double *restrict increment = scratch, *restrict position = increment + modes, *restrict push = position + modes;
    double *restrict u = push + modes, *restrict forces = u + size, *restrict gaps = forces + size;
    double *restrict slips = gaps + count, *restrict away = slips + count, *restrict x = away + count, *restrict m = x + size;
    int status[count], may_touch[count];
    for (long n = 0; n < steps; n++) {
        for (int k = 0; k < modes; k++) {
            increment[k] = kept[k] * d[k] - stiffness[k] * q[k] + load[k];
            position[k] = q[k] + increment[k];
        }
        for (int i = 0; i < count; i++) {
            const double *restrict a = rows + 2 * i * modes, *restrict b = a + modes;
            double across = 0.0, along = 0.0;
            for (int k = 0; k < modes; k++) {
                across += a[k] * position[k];
                along += b[k] * position[k];
            }
            const double *c = carried + CARRIED * i;
            gaps[i] = u[2 * i] = opening[i] + across;
            slips[i] = u[2 * i + 1] = along - belt * (n + 1) - c[MATERIAL];
            away[i] = c[STATUS] == 1.0 ? c[MATERIAL] - c[ANCHOR] : 0.0;
        }
        for (int i = 0; i < count; i++) {
            const double *c = carried + CARRIED * i;
            const int closed = c[STATUS] > 0.5;
            forces[2 * i] = closed ? c[LAST_NORMAL] : 0.0;
            forces[2 * i + 1] = closed ? c[LAST_TANGENTIAL] : 0.0;
            may_touch[i] = forces[2 * i] > 0.0;
            status[i] = may_touch[i] ? (int)c[STATUS] : 0;
            if (may_touch[i])
                displace(size, w, u, i, forces[2 * i], forces[2 * i + 1]);
        }
        double before = INFINITY;
        for (int sweep = 0; sweep < most_sweeps; sweep++) {
            double change = 0.0, largest = 0.0;
            int settled = 1;
            for (int i = 0; i < count; i++) {
                may_touch[i] |= u[2 * i] < 0.0;
                if (!may_touch[i])
                    continue;
                const double *own = w + 2 * i * size + 2 * i, *c = carried + CARRIED * i;
                const double w_nn = own[0], w_nt = own[1], w_tn = own[size], w_tt = own[size + 1];
                const double was_normal = forces[2 * i], was_tangential = forces[2 * i + 1];
                const double gap = u[2 * i] - w_nn * was_normal + w_nt * was_tangential;
                const double slip = u[2 * i + 1] - w_tn * was_normal + w_tt * was_tangential;
                double normal = 0.0, tangential = 0.0;
                int now = 0;
                if (gap < 0.0) {
                    const double stick = slip + away[i], share = 1.0 / (w_nn * w_tt - w_nt * w_tn);
                    normal = (w_nt * stick - w_tt * gap) * share;
                    tangential = (w_nn * stick - w_tn * gap) * share;
                    now = 1;
                    if (fabs(tangential) > mu * normal) {
                        const double ratio = tangential < 0.0 ? -mu : mu;
                        normal = -gap / (w_nn - ratio * w_nt);
                        tangential = ratio * normal;
                        now = 2;
                    }
                    const double last = c[LAST_SLIP];
                    if (c[STATUS] == 2.0 && last != 0.0 && (now == 1 || tangential * last < 0.0)) {
                        const double ratio = last < 0.0 ? -mu : mu;
                        const double free_on = w_nn - ratio * w_nt, free_back = w_nn + ratio * w_nt;
                        const double on = -gap / free_on, farther = slip + (w_tn - ratio * w_tt) * on;
                        if (free_on > 0.0 && free_back > 0.0 && farther * last < 0.0) {
                            const double left = last / (last - farther), undone = slip - last;
                            double pressed = (w_nt * undone - w_tt * gap) * share;
                            double needed = (w_nn * undone - w_tn * gap) * share;
                            now = 1;
                            if (fabs(needed) > mu * pressed) {
                                pressed = -gap / free_back;
                                needed = -ratio * pressed;
                                now = 2;
                            }
                            normal = left * on + (1.0 - left) * pressed;
                            tangential = left * ratio * on + (1.0 - left) * needed;
                        }
                    }
                }
                settled &= now == status[i];
                status[i] = now;
                displace(size, w, u, i, normal - was_normal, tangential - was_tangential);
                forces[2 * i] = normal;
                forces[2 * i + 1] = tangential;
                change = fmax(change, fmax(fabs(normal - was_normal), fabs(tangential - was_tangential)));
                largest = fmax(largest, fmax(normal, fabs(tangential)));
            }
            sums[0] += 1.0;
            if (change <= 1e-14 * largest)
                break;
            if (change < before && before < 1e300 && change / largest * fmax(change / (before - change), 0.1) <= tolerance)
                break;
            before = change;
            if (sweep + 1 == FIRST_DIRECT_SOLVE || (sweep + 1) % SWEEPS_PER_DIRECT_SOLVE == 0)
                if (settled) {
                    solve_states(count, w, gaps, slips, away, u, forces, status, m, x);
                    before = INFINITY;
                }
        }
        memset(push, 0, modes * sizeof *push);
        for (int i = 0; i < count; i++)
            if (status[i]) {
                const double *restrict a = rows + 2 * i * modes, *restrict b = a + modes;
                const double normal = forces[2 * i], tangential = forces[2 * i + 1];
                for (int k = 0; k < modes; k++)
                    push[k] += a[k] * normal - b[k] * tangential;
            }
        double exchanged = 0.0, lost = 0.0;
        for (int k = 0; k < modes; k++) {
            const double step = increment[k] + push[k], both = step + d[k];
            exchanged += push[k] * both;
            lost += (1.0 - kept[k]) * both * both;
            q[k] += step;
            d[k] = step;
        }
        ledger[CONTACT_WORK] += 0.5 * exchanged;
        ledger[DAMPING_LOSS] += 0.25 * lost;
        for (int i = 0; i < count; i++) {
            double *c = carried + CARRIED * i;
            const double normal = forces[2 * i], tangential = forces[2 * i + 1], slip = u[2 * i + 1];
            ledger[CONTACT_WORK] += tangential * belt;
            ledger[DRIVE_WORK] -= tangential * belt;
            ledger[FRICTION_LOSS] += fabs(tangential * slip);
            sums[1] += normal;
            sums[2] += tangential;
            sums[3 + status[i]] += 1.0;
            if (status[i] == 1 && c[STATUS] != 1.0)
                c[ANCHOR] = c[MATERIAL];
            c[MATERIAL] += slip;
            c[LAST_SLIP] = slip;
            c[STATUS] = status[i];
            c[LAST_NORMAL] = normal;
            c[LAST_TANGENTIAL] = tangential;
        }
    }
}
