/*
 * The whole-body QP with active inequalities, from the factors of the one under its equalities alone.
 *
 * The dual method of Goldfarb and Idnani (Mathematical Programming 27, 1983) in the range space: with H = U'U and the
 * normals N of all that is active, U'^-1 N = Q R. Its first columns are those of the equalities, which stay.
 */
#include "algebra.h"
#include "kernels.h"

/* Share of a normal that may be left beside those of what is active, squared, without being taken for none. */
#define DEPENDENT 1e-18

static const int64_t most_rounds = 60;

/* The inequality that is violated most and is not active, twice its number and 1 for an upper bound; -1 for none. */
static int64_t violated(const ActiveQp *solver, int64_t count, double *slack) {
    const EqualityQp *qp = solver->qp;
    const int64_t n = qp->variables;
    int64_t found = -1;
    *slack = -solver->tolerance;
    for (int64_t i = 0; i < n + qp->rows; i++) {
        if (i >= n && i < n + qp->equalities) continue;
        const double value = i < n ? qp->x[i] : dot(qp->A + n * (i - n), qp->x, n);
        const double below = value - qp->lower[i], above = qp->upper[i] - value;
        const int64_t code = 2 * i + (above < below);
        const double left = above < below ? above : below;
        if (left >= *slack) continue;
        int taken = 0;
        for (int64_t k = 0; k < count; k++) taken |= solver->active[k] == code;
        if (!taken) *slack = left, found = code;
    }
    return found;
}

/* U'^-1 times the inward normal of an inequality. */
static void turned_normal(const EqualityQp *qp, int64_t code, double *y) {
    const int64_t n = qp->variables, i = code / 2;
    const double sign = code % 2 ? -1.0 : 1.0;
    memset(y, 0, n * sizeof(double));
    if (i < n)
        y[i] = sign;
    else
        for (int64_t j = 0; j < n; j++) y[j] = sign * qp->A[n * (i - n) + j];
    forward_solve(qp->factor, n, n, y, 1);
}

/* Column of R for a turned normal beside the first `count` inequalities; returns the square of what is left of it. */
static double column_of(const ActiveQp *solver, const double *y, int64_t count, double *column) {
    const EqualityQp *qp = solver->qp;
    const int64_t n = qp->variables, m = qp->equalities, width = padded(m + 1), size = m + solver->most;
    memset(column, 0, m * sizeof(double));
    for (int64_t i = 0; i < n; i++)
        for (int64_t e = 0; e < m && y[i] != 0.0; e++) column[e] += qp->right_sides[width * i + e] * y[i];
    forward_solve(qp->schur, m, width, column, 1);
    for (int64_t k = 0; k < count; k++) {
        const double *other = solver->columns + size * k;
        column[m + k] = (dot(solver->normals + n * k, y, n) - dot(other, column, m + k)) / other[m + k];
    }
    return dot(y, y, n) - dot(column, column, m + count);
}

/* r of R r = column, for all that is active. */
static void shares_of(const ActiveQp *solver, const double *column, int64_t count, double *r) {
    const EqualityQp *qp = solver->qp;
    const int64_t m = qp->equalities, size = m + solver->most;
    memcpy(r, column, (m + count) * sizeof(double));
    for (int64_t k = count - 1; k >= 0; k--) {
        const double *own = solver->columns + size * k;
        r[m + k] /= own[m + k];
        for (int64_t i = 0; i < m + k; i++) r[i] -= own[i] * r[m + k];
    }
    backward_solve(qp->schur, m, padded(m + 1), r);
}

/* Moves x along the way on which what is active stays as it is. */
static void go(const ActiveQp *solver, const double *y, const double *r, int64_t count, double step, double *way) {
    const EqualityQp *qp = solver->qp;
    const int64_t n = qp->variables, m = qp->equalities, width = padded(m + 1);
    for (int64_t i = 0; i < n; i++) way[i] = y[i] - dot(qp->right_sides + width * i, r, m);
    for (int64_t k = 0; k < count; k++)
        for (int64_t i = 0; i < n; i++) way[i] -= solver->normals[n * k + i] * r[m + k];
    backward_solve(qp->factor, n, n, way);
    for (int64_t i = 0; i < n; i++) qp->x[i] += step * way[i];
}

/* Lets an inequality go, and makes the columns of those after it anew. */
static void leave(const ActiveQp *solver, int64_t place, int64_t count) {
    const EqualityQp *qp = solver->qp;
    const int64_t n = qp->variables, size = qp->equalities + solver->most;
    for (int64_t k = place; k + 1 < count; k++) {
        solver->active[k] = solver->active[k + 1];
        solver->multipliers[k] = solver->multipliers[k + 1];
        memcpy(solver->normals + n * k, solver->normals + n * (k + 1), n * sizeof(double));
        double *column = solver->columns + size * k;
        column[qp->equalities + k] = sqrt(column_of(solver, solver->normals + n * k, k, column));
    }
}

/* Takes back what rounding on the way has left of the constraints that are active. */
static void mend(const ActiveQp *solver, double *none, double *r, int64_t count, double *way) {
    const EqualityQp *qp = solver->qp;
    const int64_t n = qp->variables, m = qp->equalities, size = m + solver->most;
    double *left = solver->columns + size * count;
    for (int64_t e = 0; e < m; e++) left[e] = qp->lower[n + e] - dot(qp->A + n * e, qp->x, n);
    forward_solve(qp->schur, m, padded(m + 1), left, 1);
    for (int64_t k = 0; k < count; k++) {
        const int64_t code = solver->active[k], i = code / 2;
        const double *column = solver->columns + size * k;
        const double value = i < n ? qp->x[i] : dot(qp->A + n * (i - n), qp->x, n);
        const double short_of = code % 2 ? value - qp->upper[i] : qp->lower[i] - value;
        left[m + k] = (short_of - dot(column, left, m + k)) / column[m + k];
    }
    shares_of(solver, left, count, r);
    memset(none, 0, n * sizeof(double));
    go(solver, none, r, count, -1.0, way);
}

/* After `equality_qp_solve`, from its x on; returns how many inequalities came or went, -1 where it gives up. */
int64_t active_qp_solve(const ActiveQp *solver) {
    const EqualityQp *qp = solver->qp;
    const int64_t n = qp->variables, m = qp->equalities, size = m + solver->most;
    double *y = solver->work, *way = y + n, *r = way + n, *u = solver->multipliers, slack;
    int64_t count = 0, rounds = 0;
    for (;;) {
        const int64_t code = violated(solver, count, &slack);
        if (code < 0) {
            mend(solver, y, r, count, way);
            return rounds;
        }
        if (count == solver->most) return -1;
        double own = 0.0;
        turned_normal(qp, code, y);
        for (int taken = 0; !taken;) {
            if (rounds++ == most_rounds || slack != slack) return -1;
            double *column = solver->columns + size * count, step = INFINITY;
            const double free = column_of(solver, y, count, column);
            const double full = free > DEPENDENT * dot(y, y, n) ? -slack / free : INFINITY;
            int64_t first = -1;
            shares_of(solver, column, count, r);
            for (int64_t k = 0; k < count; k++)
                if (r[m + k] > 0.0 && u[k] / r[m + k] < step) step = u[k] / r[m + k], first = k;
            taken = full <= step;
            if (taken) step = full;
            if (step == INFINITY) return -1;
            if (full < INFINITY) {
                go(solver, y, r, count, step, way);
                slack += step * free;
            }
            for (int64_t k = 0; k < count; k++) u[k] -= step * r[m + k];
            own += step;
            if (!taken) {
                leave(solver, first, count--);
                continue;
            }
            memcpy(solver->normals + n * count, y, n * sizeof(double));
            column[m + count] = sqrt(free);
            u[count] = own;
            solver->active[count++] = code;
        }
    }
}
