/* Gauss's elimination by columns, right sides last; 0 where a pivot is. */
static int eliminate(double *restrict m, double *restrict x, int equations, int size)
{
    for (int k = 0; k < equations; k++) {
        double *restrict pivots = m + k * size;
        if (pivots[k] == 0.0)
            return 0;
        const double inverse = 1.0 / pivots[k];
        for (int r = k + 1; r < equations; r++)
            pivots[r] *= inverse;
        for (int c = k + 1; c < equations; c++) {
            double *restrict column = m + c * size;
            const double factor = column[k];
            for (int r = k + 1; r < equations; r++)
                column[r] -= factor * pivots[r];
        }
        const double factor = x[k];
        for (int r = k + 1; r < equations; r++)
            x[r] -= factor * pivots[r];
    }
    for (int k = equations - 1; k >= 0; k--) {
        const double *restrict column = m + k * size, found = x[k] / column[k];
        x[k] = found;
        for (int r = 0; r < k; r++)
            x[r] -= column[r] * found;
    }
    return 1;
}
