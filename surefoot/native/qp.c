/* The whole-body QP under its equalities alone (see `wbc.solvers`), and what a solution means for the robot. */
#include "algebra.h"
#include "kernels.h"

/* Right sides of the triangular solves lie in rows of a whole number of these, so that loops over them are regular. */
#define WIDTH 4

int64_t padded(int64_t count) { return (count + WIDTH - 1) / WIDTH * WIDTH; }

/* out -= sum of factor times row; four at a time, since to load and to store `out` costs more than the products. */
static inline void subtract_rows(double *restrict out, int64_t count, const double *factors, int64_t factor_stride,
                                 const double *rows, int64_t row_stride, int64_t terms) {
    int64_t k = 0;
    for (; k + 4 <= terms; k += 4) {
        const double *f = factors + factor_stride * k, *first = rows + row_stride * k;
        const double *second = first + row_stride, *third = second + row_stride, *fourth = third + row_stride;
        const double a = f[0], b = f[factor_stride], c = f[2 * factor_stride], d = f[3 * factor_stride];
        if (a == 0.0 && b == 0.0 && c == 0.0 && d == 0.0) continue;
        for (int64_t j = 0; j < count; j++)
            out[j] -= (a * first[j] + b * second[j]) + (c * third[j] + d * fourth[j]);
    }
    for (; k < terms; k++) {
        const double factor = factors[factor_stride * k], *row = rows + row_stride * k;
        for (int64_t j = 0; j < count; j++) out[j] -= factor * row[j];
    }
}

int cholesky(double *A, int64_t size, int64_t stride) {
    for (int64_t i = 0; i < size; i++) {
        double *row = A + stride * i + i;
        subtract_rows(row, size - i, A + i, stride, A + i, stride, i);
        if (!(row[0] > 0.0)) return 1;
        row[0] = 1.0 / sqrt(row[0]);
        for (int64_t j = 1; j < size - i; j++) row[j] *= row[0];
    }
    return 0;
}

/* Solves U'Y = B in place, for `width` right sides lying row by row. */
void forward_solve(const double *U, int64_t size, int64_t stride, double *B, int64_t width) {
    for (int64_t i = 0; i < size; i++) {
        double *y = B + width * i;
        subtract_rows(y, width, U + i, stride, B, width, i);
        for (int64_t c = 0; c < width; c++) y[c] *= U[stride * i + i];
    }
}

/* Solves U x = b in place. */
void backward_solve(const double *U, int64_t size, int64_t stride, double *x) {
    for (int64_t i = size - 1; i >= 0; i--) {
        const double *row = U + stride * i;
        x[i] = (x[i] - dot(row + i + 1, x + i + 1, size - i - 1)) * row[i];
    }
}

static int separable(const double *H, int64_t n, int64_t split) {
    for (int64_t i = 0; i < split; i++)
        for (int64_t j = split; j < n; j++)
            if (H[n * i + j] != 0.0) return 0;
    return 1;
}

/* Largest violation of bounds and rows at x; not a number where x is none. */
double qp_violation(const EqualityQp *qp) {
    const int64_t n = qp->variables;
    double worst = 0.0;
    for (int64_t i = 0; i < n + qp->rows; i++) {
        const double value = i < n ? qp->x[i] : dot(qp->A + n * (i - n), qp->x, n);
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
 * Returns the largest violation at x; infinite where H is not positive definite or the equalities contradict.
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
        forward_solve(block, ends[part] - first, n, Y + width * first, width);
    }
    for (int64_t e = 0; e < m; e++) {
        double *row = S + width * e + e;
        memset(row, 0, (width - e) * sizeof(double));
        subtract_rows(row, width - e, Y + e, width, Y + e, width, n);
        for (int64_t c = 0; c < width - e; c++) row[c] = -row[c];
    }
    for (int64_t e = 0; e < m; e++) multipliers[e] = qp->lower[n + e] + S[width * e + m];
    if (cholesky(S, m, width)) return INFINITY;
    forward_solve(S, m, width, multipliers, 1);
    backward_solve(S, m, width, multipliers);
    for (int64_t i = 0; i < n; i++) {
        const double *y = Y + width * i;
        qp->x[i] = dot(y, multipliers, m) - y[m];
    }
    for (int64_t part = 0, first = 0; part < parts; first = ends[part++])
        backward_solve(U + n * first + first, ends[part] - first, n, qp->x + first);
    return qp_violation(qp);
}

/* Torque, acceleration, wrenches and residuals of a solution. */
void answer_read(const Answer *answer) {
    const Terms *terms = answer->terms;
    const Stack *stack = answer->stack;
    const int64_t n = stack->variables, nv = terms->nv;
    const double *x = answer->x;
    for (int64_t j = 0; j < answer->joints; j++) {
        const double most = answer->torque_limit[j];
        const double torque = dot(answer->torque_rows + n * j, x, n) + terms->bias[6 + j];
        answer->torque[j] = torque > most ? most : torque < -most ? -most : torque;
    }
    memcpy(answer->acceleration, x, nv * sizeof(double));
    for (int i = 0; i < 12; i++) answer->wrench[i] = x[nv + i] * terms->wrench_unit;
    for (int64_t t = 0; t < stack->rows_count; t++) {
        answer->task_error[t] = (dot(stack->rows + n * t, x, n) - stack->target[t]) * stack->unscale[t];
    }
}

/* Solves and, where that is the minimiser, reads in one call; returns the violation as `equality_qp_solve` does. */
double qp_answer(const QpAnswer *both) {
    const double violation = equality_qp_solve(both->qp, both->split);
    if (violation <= both->accuracy) answer_read(both->answer);
    return violation;
}
