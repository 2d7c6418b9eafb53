/* The whole-body QP under its equalities alone; see `wbc.solvers.equalities_only`. What a solution means for the robot. */
#include "algebra.h"
#include "kernels.h"

/* Right sides of the triangular solves lie in rows of a whole number of these, so that loops over them are regular. */
#define WIDTH 4

static int64_t padded(int64_t count) { return (count + WIDTH - 1) / WIDTH * WIDTH; }

/* U with A = U'U in the upper triangle of A; its diagonal holds the reciprocals. Returns whether A is not positive. */
static int cholesky(double *A, int64_t size, int64_t stride) {
    for (int64_t k = 0; k < size; k++) {
        double *row = A + stride * k;
        if (!(row[k] > 0.0)) return 1;
        const double scale = 1.0 / sqrt(row[k]);
        for (int64_t j = k + 1; j < size; j++) row[j] *= scale;
        row[k] = scale;
        for (int64_t i = k + 1; i < size; i++) {
            const double factor = row[i];
            double *restrict below = A + stride * i;
            for (int64_t j = i; j < size; j++) below[j] -= factor * row[j];
        }
    }
    return 0;
}

/* Solves U'Y = B in place, for `width` right sides lying row by row. */
static void forward(const double *U, int64_t size, int64_t stride, double *B, int64_t width) {
    for (int64_t k = 0; k < size; k++) {
        const double *row = U + stride * k;
        double *y = B + width * k;
        for (int64_t c = 0; c < width; c++) y[c] *= row[k];
        for (int64_t i = k + 1; i < size; i++) {
            const double factor = row[i];
            double *restrict below = B + width * i;
            for (int64_t c = 0; c < width; c++) below[c] -= factor * y[c];
        }
    }
}

/* Solves U x = b in place. */
static void backward(const double *U, int64_t size, int64_t stride, double *x) {
    for (int64_t i = size - 1; i >= 0; i--) {
        double rest = x[i];
        for (int64_t j = i + 1; j < size; j++) rest -= U[stride * i + j] * x[j];
        x[i] = rest * U[stride * i + i];
    }
}

static int separable(const double *H, int64_t n, int64_t split) {
    for (int64_t i = 0; i < split; i++)
        for (int64_t j = split; j < n; j++)
            if (H[n * i + j] != 0.0) return 0;
    return 1;
}

/* Largest violation of bounds and rows at x; not a number where x is none. */
static double violation(const EqualityQp *qp) {
    const int64_t n = qp->variables;
    double worst = 0.0;
    for (int64_t i = 0; i < n + qp->rows; i++) {
        double value = 0.0;
        if (i < n) {
            value = qp->x[i];
        } else {
            const double *row = qp->A + n * (i - n);
            for (int64_t j = 0; j < n; j++) value += row[j] * qp->x[j];
        }
        const double below = qp->lower[i] - value, above = value - qp->upper[i];
        if (!(below <= worst)) worst = below;
        if (!(above <= worst)) worst = above;
        if (worst != worst) return worst;
    }
    return worst;
}

/*
 * With H = U'U, Y = U'^-1 E' and w = U'^-1 g the multipliers solve Y'Y l = e + Y'w, and x = U^-1 (Y l - w).
 *
 * `split`: number of the first variables of which H has no products with the others, where it has none.
 * Returns the largest violation at x; infinite where H is not positive definite or the equalities contradict each other.
 */
double equality_qp_solve(const EqualityQp *qp, int64_t split) {
    const int64_t n = qp->variables, m = qp->equalities, width = padded(m + 1);
    double *U = qp->factor, *Y = qp->right_sides, *S = qp->schur, *multipliers = qp->multipliers;
    const int64_t parts = separable(qp->H, n, split) ? 2 : 1, ends[2] = {parts == 2 ? split : n, n};
    for (int64_t i = 0; i < n; i++) {
        memcpy(U + n * i + i, qp->H + n * i + i, (n - i) * sizeof(double));
        double *y = Y + width * i;
        for (int64_t e = 0; e < m; e++) y[e] = qp->A[n * e + i];
        y[m] = qp->g[i];
        for (int64_t c = m + 1; c < width; c++) y[c] = 0.0;
    }
    for (int64_t part = 0, first = 0; part < parts; first = ends[part++]) {
        double *block = U + n * first + first;
        if (cholesky(block, ends[part] - first, n)) return INFINITY;
        forward(block, ends[part] - first, n, Y + width * first, width);
    }
    memset(S, 0, m * width * sizeof(double));
    for (int64_t i = 0; i < n; i++) {
        const double *restrict y = Y + width * i;
        for (int64_t e = 0; e < m; e++) {
            const double factor = y[e];
            double *restrict row = S + width * e;
            if (factor == 0.0) continue;
            for (int64_t c = 0; c < width; c++) row[c] += factor * y[c];
        }
    }
    for (int64_t e = 0; e < m; e++) multipliers[e] = qp->lower[n + e] + S[width * e + m];
    if (cholesky(S, m, width)) return INFINITY;
    forward(S, m, width, multipliers, 1);
    backward(S, m, width, multipliers);
    for (int64_t i = 0; i < n; i++) {
        const double *y = Y + width * i;
        double sum = -y[m];
        for (int64_t e = 0; e < m; e++) sum += y[e] * multipliers[e];
        qp->x[i] = sum;
    }
    for (int64_t part = 0, first = 0; part < parts; first = ends[part++])
        backward(U + n * first + first, ends[part] - first, n, qp->x + first);
    return violation(qp);
}

/* Torque, acceleration, wrenches and residuals of a solution. */
void answer_read(const Answer *answer) {
    const Terms *terms = answer->terms;
    const Stack *stack = answer->stack;
    const int64_t n = stack->variables, nv = terms->nv;
    const double *x = answer->x;
    for (int64_t j = 0; j < answer->joints; j++) {
        const double *row = answer->torque_rows + n * j, most = answer->torque_limit[j];
        double torque = 0.0;
        for (int64_t i = 0; i < n; i++) torque += row[i] * x[i];
        torque += terms->bias[6 + j];
        answer->torque[j] = torque > most ? most : torque < -most ? -most : torque;
    }
    memcpy(answer->acceleration, x, nv * sizeof(double));
    for (int i = 0; i < 12; i++) answer->wrench[i] = x[nv + i] * terms->wrench_unit;
    for (int64_t t = 0; t < stack->rows_count; t++) {
        double value = 0.0;
        for (int64_t i = 0; i < n; i++) value += stack->rows[n * t + i] * x[i];
        answer->task_error[t] = (value - stack->target[t]) * stack->unscale[t];
    }
}
