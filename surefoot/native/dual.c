/* A strictly convex QP by the dual method of Goldfarb and Idnani (Mathematical Programming 27, 1983). */
#include "algebra.h"
#include "kernels.h"

/* Share of a normal that may be left beside those of active constraints, squared, without being taken for none. */
#define DEPENDENT 1e-20

static const int64_t most_rounds = 200;

/* Rows of J', the columns of U^-1 for P = U'U, and the sizes of the rows of G. */
static int factorise(const BoundedQp *qp) {
    const int64_t n = qp->variables;
    memcpy(qp->factor, qp->P, n * n * sizeof(double));
    if (cholesky(qp->factor, n, n)) return 1;
    for (int64_t c = 0; c < n; c++) {
        double *column = qp->inverse + n * c;
        for (int64_t i = n - 1; i > c; i--) column[i] = 0.0;
        column[c] = qp->factor[n * c + c];
        for (int64_t i = c - 1; i >= 0; i--) {
            const double *row = qp->factor + n * i;
            column[i] = -dot(row + i + 1, column + i + 1, c - i) * row[i];
        }
    }
    for (int64_t i = 0; i < qp->rows; i++) {
        const double *row = qp->G + n * i, size = sqrt(dot(row, row, n));
        qp->share[i] = size > 0.0 ? 1.0 / size : 0.0;
    }
    return 0;
}

/* The inactive constraint that is violated most, bounds before rows, or -1; by how much it is, and its normal inwards.
 * Their order: lower bounds, upper bounds, rows. */
static int64_t violated(const BoundedQp *qp, double *slack, double *normal) {
    const int64_t n = qp->variables;
    const double *x = qp->x;
    int64_t found = -1;
    *slack = -qp->tolerance;
    for (int64_t i = 0; i < n; i++) {
        const double below = (x[i] - qp->lower[i]) / (1.0 + fabs(x[i]));
        const double above = (qp->upper[i] - x[i]) / (1.0 + fabs(x[i]));
        if (!(below >= *slack) && !qp->taken[i]) *slack = below, found = i;
        if (!(above >= *slack) && !qp->taken[n + i]) *slack = above, found = n + i;
    }
    if (found >= 0) {
        const int64_t i = found < n ? found : found - n;
        memset(normal, 0, n * sizeof(double));
        normal[i] = found < n ? 1.0 : -1.0;
        *slack = found < n ? x[i] - qp->lower[i] : qp->upper[i] - x[i];
        return found;
    }
    for (int64_t i = 0; i < qp->rows; i++) {
        const double left = (qp->h[i] - dot(qp->G + n * i, x, n)) * qp->share[i];
        if (!(left >= *slack) && !qp->taken[2 * n + i]) *slack = left, found = i;
    }
    if (found < 0) return -1;
    for (int64_t i = 0; i < n; i++) normal[i] = -qp->share[found] * qp->G[n * found + i];
    return 2 * n + found;
}

/* Turns two vectors so that a pair of their coordinates (a, b) would become (sqrt(a a + b b), 0). */
static void turn(double a, double b, double *first, double *second, int64_t count) {
    const double size = sqrt(a * a + b * b), c = a / size, s = b / size;
    for (int64_t i = 0; i < count; i++) {
        const double one = first[i], other = second[i];
        first[i] = c * one + s * other;
        second[i] = c * other - s * one;
    }
}

/* Takes a constraint with J' times its normal as the last active one. */
static void take(const BoundedQp *qp, double *normal, int64_t active) {
    const int64_t n = qp->variables;
    for (int64_t j = n - 1; j > active; j--) {
        if (normal[j] == 0.0) continue;
        turn(normal[j - 1], normal[j], qp->rotated + n * (j - 1), qp->rotated + n * j, n);
        normal[j - 1] = sqrt(normal[j - 1] * normal[j - 1] + normal[j] * normal[j]);
    }
    for (int64_t i = 0; i <= active; i++) qp->triangle[n * i + active] = normal[i];
}

/* Leaves the active constraint of that place; there is one less then. */
static void leave(const BoundedQp *qp, int64_t place, int64_t active) {
    const int64_t n = qp->variables;
    double *R = qp->triangle;
    qp->taken[qp->active[place]] = 0;
    for (int64_t k = place; k + 1 < active; k++) {
        qp->active[k] = qp->active[k + 1];
        qp->multipliers[k] = qp->multipliers[k + 1];
        for (int64_t i = 0; i <= k + 1; i++) R[n * i + k] = R[n * i + k + 1];
    }
    for (int64_t k = place; k + 1 < active; k++) {
        const double a = R[n * k + k], b = R[n * (k + 1) + k];
        if (b == 0.0) continue;
        turn(a, b, R + n * k + k, R + n * (k + 1) + k, active - 1 - k);
        turn(a, b, qp->rotated + n * k, qp->rotated + n * (k + 1), n);
    }
}

/* `same`: whether P and G are those of the call before. Returns whether there is no solution, or none was found. */
int64_t bounded_qp_solve(const BoundedQp *qp, int64_t same) {
    const int64_t n = qp->variables;
    double *x = qp->x, *J = qp->rotated, *R = qp->triangle, *u = qp->multipliers;
    double *normal = qp->work, *seen = normal + n, *way = seen + n, *change = way + n;
    int64_t active = 0;
    if (!same && factorise(qp)) return 1;
    memcpy(J, qp->inverse, n * n * sizeof(double));
    memset(qp->taken, 0, (2 * n + qp->rows) * sizeof(int64_t));
    memset(x, 0, n * sizeof(double));
    for (int64_t c = 0; c < n; c++) {
        const double share = dot(J + n * c, qp->q, n);
        for (int64_t i = 0; i <= c; i++) x[i] -= share * J[n * c + i];
    }
    for (int64_t round = 0; round < most_rounds;) {
        double slack, own = 0.0;
        const int64_t found = violated(qp, &slack, normal);
        if (found < 0) return !isfinite(dot(x, x, n));
        for (int taken = 0; !taken; round++) {
            if (round >= most_rounds || slack != slack) return 1;
            double whole = 0.0, free = 0.0, step = INFINITY;
            int64_t first = -1;
            memset(way, 0, n * sizeof(double));
            for (int64_t k = 0; k < n; k++) {
                seen[k] = dot(J + n * k, normal, n);
                whole += seen[k] * seen[k];
                if (k < active) continue;
                free += seen[k] * seen[k];
                for (int64_t i = 0; i < n; i++) way[i] += seen[k] * J[n * k + i];
            }
            for (int64_t k = active - 1; k >= 0; k--) {
                change[k] = (seen[k] - dot(R + n * k + k + 1, change + k + 1, active - 1 - k)) / R[n * k + k];
                if (change[k] > 0.0 && u[k] / change[k] < step) step = u[k] / change[k], first = k;
            }
            const double full = free > DEPENDENT * whole ? -slack / free : INFINITY;
            taken = full <= step;
            if (taken) step = full;
            if (step == INFINITY) return 1;
            if (full < INFINITY) {
                for (int64_t i = 0; i < n; i++) x[i] += step * way[i];
                slack += step * free;
            }
            for (int64_t k = 0; k < active; k++) u[k] -= step * change[k];
            own += step;
            if (!taken) {
                leave(qp, first, active--);
                continue;
            }
            take(qp, seen, active);
            u[active] = own;
            qp->taken[found] = 1;
            qp->active[active++] = found;
        }
    }
    return 1;
}
