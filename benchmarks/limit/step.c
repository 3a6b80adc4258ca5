/* The step of the march for one contact on a beam under Coulomb's law, ledger and one probe included, as fast as C goes.

   Modes in the order slider, bending, axial. Compiled by limit.py; what it computes is checked there against the package.
*/
#include <math.h>

#define R restrict

enum { DRIVE, CONTACT, FRICTION, CONVECTION, DAMPING, NORMAL, TANGENTIAL, SEPARATED, STICKING, SLIDING, SUMS };
enum { MATERIAL, ANCHOR, STATUS, ABSCISSA, BEFORE };
enum { START, GAP, WAVENUMBER, AMPLITUDE, FRICTION_RATIO, W_NN, W_NT, W_TT };

static void harmonics(double theta, int count, double *R s, double *R c)
{
    double sine = sin(theta), cosine = cos(theta);
    s[0] = sine;
    c[0] = cosine;
    for (int filled = 1; filled < count; filled *= 2) {
        for (int k = 0; k < filled; k++) {
            s[filled + k] = sine * c[k] + cosine * s[k];
            c[filled + k] = cosine * c[k] - sine * s[k];
        }
        double twice = 2.0 * sine * cosine;
        cosine = 1.0 - 2.0 * sine * sine;
        sine = twice;
    }
}

void march(long steps, int slider, int bending, int axial, const double *R b, const double *R r, const double *R ch,
           const double *R hc, const double *R hl, const double *R tip_x, const double *R tip_y, const double *R load,
           const double *R probe, const double *R constants, double *R q, double *R d, double *R dn, double *R s,
           double *R c, double *R carried, double *R sums, double *R raw)
{
    const int track = slider + bending, most = bending > axial ? bending : axial;
    const double wavenumber = constants[WAVENUMBER], amplitude = constants[AMPLITUDE], mu = constants[FRICTION_RATIO];
    double material = carried[MATERIAL], anchor = carried[ANCHOR], place = carried[ABSCISSA], before = carried[BEFORE];
    int status = (int)carried[STATUS];
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
            w_bend += s[k] * s[k] * ch[j];
        }
        for (int k = 0; k < axial; k++) {
            const int j = track + k;
            dn[j] = b[j] * d[j] - r[j] * q[j] + load[j];
            stretch += s[k] * (q[j] + dn[j]);
            w_axial += s[k] * s[k] * ch[j];
        }
        const double gap = constants[GAP] + y - amplitude * bend, moved = trial - amplitude * stretch;
        double normal = 0.0, tangential = 0.0;
        double w_nn = constants[W_NN], w_nt = constants[W_NT], w_tt = constants[W_TT];
        const int was = status;
        status = 0;
        if (gap < 0.0) {
            w_nn += amplitude * amplitude * w_bend;
            w_tt += amplitude * amplitude * w_axial;
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
        }
        if (status == 1 && was != 1)
            anchor = material;
        const double slipped = moved + w_nt * normal - w_tt * tangential;
        const double new_place = trial + w_nt * normal - constants[W_TT] * tangential;
        double exchanged = 0.0, given = 0.0, lost = 0.0, value = 0.0;
        for (int k = 0; k < slider; k++) {
            const double push = tip_y[k] * normal - tip_x[k] * tangential, step = dn[k] + ch[k] * push, both = step + d[k];
            exchanged += push * both;
            given += load[k] * both * hc[k];
            lost += hl[k] * both * both;
            q[k] += step;
            d[k] = step;
        }
        double slope = 0.0;
        const double up = -amplitude * normal, along = amplitude * tangential;
        for (int k = 0; k < bending; k++) {
            const int j = slider + k;
            const double push = up * s[k], step = dn[j] + ch[j] * push, both = step + d[j];
            exchanged += push * both;
            given += load[j] * both * hc[j];
            lost += hl[j] * both * both;
            value += probe[k] * (step - d[j]);
            q[j] += step;
            d[j] = step;
            slope += (k + 1) * c[k] * q[j];
        }
        double along_slope = 0.0;
        for (int k = 0; k < axial; k++) {
            const int j = track + k;
            const double push = along * s[k], step = dn[j] + ch[j] * push, both = step + d[j];
            exchanged += push * both;
            given += load[j] * both * hc[j];
            lost += hl[j] * both * both;
            q[j] += step;
            d[j] = step;
            along_slope += (k + 1) * c[k] * q[j];
        }
        sums[DRIVE] += given;
        sums[DAMPING] += lost;
        sums[CONTACT] += 0.5 * exchanged;
        sums[FRICTION] += tangential * (slipped - material);
        sums[CONVECTION] -= wavenumber * 0.5 * (new_place - before) * (up * slope + along * along_slope);
        sums[NORMAL] += normal;
        sums[TANGENTIAL] += tangential;
        sums[SEPARATED + status] += 1.0;
        raw[n] = value;
        material = slipped;
        before = place;
        place = new_place;
    }
    carried[MATERIAL] = material;
    carried[ANCHOR] = anchor;
    carried[STATUS] = status;
    carried[ABSCISSA] = place;
    carried[BEFORE] = before;
}
