/* The step of the march for one contact on a beam under Coulomb's law, ledger and one probe included, as fast as C goes.

   Modes in the order slider, bending, axial. Compiled by against_c.py; what it computes is checked there against the package.
   Places in `constants`, `carried`, `energies` and `columns` have the names of the package's own layout: layout.h is written
   from it. Arguments of `march` are given by their names, too.
*/
#include <math.h>

#include "layout.h"

/* Sines and cosines of eight angles from 0 to pi, by the polynomials of FreeBSD's msun. */
static void sines(const double *restrict theta, double *restrict sine, double *restrict cosine)
{
    for (int k = 0; k < 8; k++) {
        double x = 0.5 * (theta[k] - 1.57079632679489661923), z = x * x;
        double s = 2.75573137070700676789e-06 + z * (-2.50507602534068634195e-08 + z * 1.58969099521155010221e-10);
        s = -1.66666666666666324348e-01 + z * (8.33333333332248946124e-03 + z * (-1.98412698298579493134e-04 + z * s));
        s = x + x * z * s;
        double c = -2.75573143513906633035e-07 + z * (2.08757232129817482790e-09 + z * -1.13596475577881948265e-11);
        c = 4.16666666666666019037e-02 + z * (-1.38888888888741095749e-03 + z * (2.48015872894767294178e-05 + z * c));
        c = 1.0 - 0.5 * z + z * z * c;
        sine[k] = 1.0 - 2.0 * s * s;
        cosine[k] = -2.0 * s * c;
    }
}

/* sin(k theta) and cos(k theta), k from 1: the first eight at once, the others turned on by eight at a time. */
static void harmonics(double theta, int count, double *restrict s, double *restrict c)
{
    double angle[8], sign[8];
    for (int k = 0; k < 8; k++) {
        const double turns = (k + 1) * (theta / 3.14159265358979323846), whole = floor(turns);
        angle[k] = (turns - whole) * 3.14159265358979323846;
        sign[k] = 1.0 - 2.0 * (whole - 2.0 * floor(0.5 * whole));
    }
    sines(angle, s, c);
    for (int k = 0; k < 8; k++) {
        s[k] *= sign[k];
        c[k] *= sign[k];
    }
    const double sine = s[7], cosine = c[7];
    for (int first = 8; first < count; first += 8)
        for (int k = 0; k < 8; k++) {
            s[first + k] = s[first - 8 + k] * cosine + c[first - 8 + k] * sine;
            c[first + k] = c[first - 8 + k] * cosine - s[first - 8 + k] * sine;
        }
}

/* What a constant load has given, up to a constant: the sum of its work over the steps telescopes. */
static double work_of_load(int modes, const double *restrict load, const double *restrict half_l, const double *restrict q,
                           const double *restrict d)
{
    double work = 0.0;
    for (int k = 0; k < modes; k++)
        work += load[k] * half_l[k] * (2.0 * q[k] - d[k]);
    return work;
}

void march(long steps, int slider, int bending, int axial, double mu, double fixed_nn, double w_nt, double fixed_tt,
           double amplitude,            const double *restrict constants, const double *restrict b, const double *restrict r,
           const double *restrict l, const double *restrict half_l, const double *restrict loss,
           const double *restrict tip_x, const double *restrict tip_y, const double *restrict load,
           const double *restrict probe, double *restrict q, double *restrict d, double *restrict dn,
           double *restrict s, double *restrict c, double *restrict carried, double *restrict energies,
           double *restrict columns, double *restrict raw)
{
    const int track = slider + bending, most = bending > axial ? bending : axial;
    const double wavenumber = constants[ALONG];
    double material = carried[MATERIAL], anchor = carried[ANCHOR];
    double place = carried[ABSCISSA], before = carried[ABSCISSA_BEFORE], last_slip = carried[LAST_SLIP];
    double normal = carried[LAST_NORMAL], tangential = carried[LAST_TANGENTIAL];
    double last_gap = carried[LAST_GAP], closed = carried[CLOSED_SHARE];
    int status = (int)carried[STATUS];
    energies[DRIVE_WORK] -= work_of_load(track + axial, load, half_l, q, d);
    for (long n = 0; n < steps; n++) {
        double x = 0.0, y = 0.0, bend = 0.0, w_bend = 0.0, stretch = 0.0, w_axial = 0.0;
        for (int k = 0; k < slider; k++) {
            dn[k] = b[k] * d[k] - r[k] * q[k] + load[k];
            double position = q[k] + dn[k];
            x += tip_x[k] * position;
            y += tip_y[k] * position;
        }
        const double trial = constants[START] + x;
        harmonics(wavenumber * trial, most, s, c);
        for (int k = 0; k < bending; k++) {
            const int j = slider + k;
            dn[j] = b[j] * d[j] - r[j] * q[j] + load[j];
            bend += s[k] * (q[j] + dn[j]);
            w_bend += s[k] * s[k] * l[j];
        }
        for (int k = 0; k < axial; k++) {
            const int j = track + k;
            dn[j] = b[j] * d[j] - r[j] * q[j] + load[j];
            stretch += s[k] * (q[j] + dn[j]);
            w_axial += s[k] * s[k] * l[j];
        }
        const double gap = constants[GAP] + y - amplitude * bend, moved = trial - amplitude * stretch;
        const double w_nn = fixed_nn + amplitude * amplitude * w_bend, w_tt = fixed_tt + amplitude * amplitude * w_axial;
        const int was = status;
        if (was && gap >= 0.0) {
            const double free = w_nn - tangential / normal * w_nt;
            closed += normal / (normal + gap / (free > 0.0 ? free : w_nn)) - 1.0;
            closed = closed > 0.0 ? closed : 0.0;
        }
        columns[SEPARATED] += 1.0 - closed;
        if (was)
            columns[SEPARATED + was] += closed;
        const double last_normal = normal, last_tangential = tangential, was_closed = closed;
        normal = tangential = closed = 0.0;
        status = 0;
        if (gap < 0.0) {
            const double slip = moved - (was == 1 ? anchor : material), determinant = w_nn * w_tt - w_nt * w_nt;
            normal = (w_nt * slip - w_tt * gap) / determinant;
            tangential = (w_nn * slip - w_nt * gap) / determinant;
            status = 1;
            if (fabs(tangential) > mu * normal) {
                const double sense = tangential >= 0.0 ? 1.0 : -1.0;
                normal = -gap / (w_nn - sense * mu * w_nt);
                tangential = sense * mu * normal;
                status = 2;
            }
            if (was == 2 && last_slip != 0.0 && (status == 1 || tangential * last_slip < 0.0)) {
                const double ratio = last_slip < 0.0 ? -mu : mu;
                const double free_on = w_nn - ratio * w_nt, free_back = w_nn + ratio * w_nt;
                const double on = -gap / free_on, farther = slip + (w_nt - ratio * w_tt) * on;
                if (free_on > 0.0 && free_back > 0.0 && farther * last_slip < 0.0) {
                    const double share = last_slip / (last_slip - farther), undone = slip - last_slip;
                    double pressed = (w_nt * undone - w_tt * gap) / determinant;
                    double needed = (w_nn * undone - w_nt * gap) / determinant;
                    status = 1;
                    if (fabs(needed) > mu * pressed) {
                        pressed = -gap / free_back;
                        needed = -ratio * pressed;
                        status = 2;
                    }
                    normal = share * on + (1.0 - share) * pressed;
                    tangential = share * ratio * on + (1.0 - share) * needed;
                }
            }
            if (was == 1 && status == 2) {
                const double pressed = (w_nt * slip - w_tt * gap) / determinant, needed = (w_nn * slip - w_nt * gap) / determinant;
                const double sense = needed < 0.0 ? -1.0 : 1.0;
                const double inside = mu * last_normal - sense * last_tangential, outside = sense * needed - mu * pressed;
                const double sooner = outside > 0.0 ? was_closed * outside / (inside + outside) : 0.0;
                columns[STICKING] -= sooner;
                columns[SLIDING] += sooner;
            }
            closed = was ? 1.0 : gap / (gap - last_gap);
        }
        last_gap = gap > 0.0 ? gap : 0.0;
        if (status == 1 && was != 1)
            anchor = material;
        const double slipped = moved + w_nt * normal - w_tt * tangential;
        const double new_place = trial + w_nt * normal - fixed_tt * tangential;
        double exchanged = 0.0, lost = 0.0, value = 0.0;
        for (int k = 0; k < slider; k++) {
            const double push = tip_y[k] * normal - tip_x[k] * tangential, step = dn[k] + l[k] * push;
            const double both = step + d[k];
            exchanged += push * both;
            lost += loss[k] * both * both;
            q[k] += step;
            d[k] = step;
        }
        double slope = 0.0;
        const double up = -amplitude * normal, along = amplitude * tangential;
        for (int k = 0; k < bending; k++) {
            const int j = slider + k;
            const double push = up * s[k], step = dn[j] + l[j] * push, both = step + d[j];
            exchanged += push * both;
            lost += loss[j] * both * both;
            value += probe[k] * (step - d[j]);
            q[j] += step;
            d[j] = step;
            slope += (k + 1) * c[k] * q[j];
        }
        double along_slope = 0.0;
        for (int k = 0; k < axial; k++) {
            const int j = track + k;
            const double push = along * s[k], step = dn[j] + l[j] * push, both = step + d[j];
            exchanged += push * both;
            lost += loss[j] * both * both;
            q[j] += step;
            d[j] = step;
            along_slope += (k + 1) * c[k] * q[j];
        }
        energies[DAMPING_LOSS] += lost;
        energies[CONTACT_WORK] += 0.5 * exchanged;
        energies[FRICTION_LOSS] += fabs(tangential * (slipped - material));
        last_slip = slipped - material;
        energies[CONVECTION_WORK] -= wavenumber * 0.5 * (new_place - before) * (up * slope + along * along_slope);
        columns[NORMAL_FORCE] += normal;
        columns[TANGENTIAL_FORCE] += tangential;
        raw[n] = value;
        material = slipped;
        before = place;
        place = new_place;
    }
    energies[DRIVE_WORK] += work_of_load(track + axial, load, half_l, q, d);
    carried[MATERIAL] = material;
    carried[ANCHOR] = anchor;
    carried[STATUS] = status;
    carried[ABSCISSA] = place;
    carried[ABSCISSA_BEFORE] = before;
}
