/* The covariance of the invariant filter, from gain to gain; see `wbc.estimation.invariant_filter`. */
#include "algebra.h"
#include "kernels.h"

enum { TURN = 0, VELOCITY = 3, POSITION = 6, FOOT = 9, SOLE = 15, GYRO = 21, FORCE = 24, FIXED = 27, AXES = 3 };
enum { POSE = 6, MOST = 12, GROUP = 15 };

static double square(double x) { return x * x; }

/* Errors after a time by those before, row by row; `B` is what turns about world axes do, shape (15, 3). */
typedef struct {
    double time;
    double gravity;
    const double *R;
    double turned[GROUP][3]; /* B R */
} Way;

/*
 * Adds to each of `count` numbers of every row of the group what other rows add in a transition; a row is `stride`
 * numbers from the next, a number of it `step` from the next. Rows are taken in an order that reads none anew.
 */
static void go_on(const Way *way, double *P, int64_t stride, int64_t step, int64_t count) {
    const double t = way->time, half = 0.5 * t * t, g = way->gravity;
    for (int64_t c = 0; c < count; c++) {
        double *x = P + step * c, gyro[3], force[3];
        const double turn[2] = {x[0], x[stride]}, speed[3] = {x[3 * stride], x[4 * stride], x[5 * stride]};
        for (int i = 0; i < 3; i++) gyro[i] = x[(GYRO + i) * stride];
        for (int i = 0; i < 3; i++) force[i] = x[(FORCE + i) * stride];
        /* hat((0, 0, -g)) x = (g x_1, -g x_0, 0) */
        const double fall[3] = {g * turn[1], -g * turn[0], 0.0};
        for (int i = 0; i < GROUP; i++) {
            double sum = 0.0;
            for (int j = 0; j < 3; j++) sum += way->turned[i][j] * gyro[j];
            x[i * stride] -= t * sum;
        }
        for (int i = 0; i < 3; i++) {
            const double pushed = way->R[3 * i] * force[0] + way->R[3 * i + 1] * force[1] + way->R[3 * i + 2] * force[2];
            x[(VELOCITY + i) * stride] += t * (fall[i] - pushed);
            x[(POSITION + i) * stride] += t * speed[i] + half * fall[i];
        }
    }
}

/* What a foot adds that stands: by the root of the time, and by its springs. */
static void add_foot(const Covariance *covariance, int k, double time) {
    const Filter *filter = covariance->filter;
    const int64_t n = filter->size, foot = FOOT + 3 * k, sole = SOLE + 3 * k;
    double *P = covariance->P, *Z = filter->Z + 9 * k, turned[3], turn[9], seen[9];
    const double loaded = 2.0 * covariance->loads[k];
    const double more = 1.0 + (covariance->light - 1.0) * (1.0 - (loaded < 1.0 ? loaded : 1.0));
    const double ways[3] = {covariance->creep, covariance->creep, covariance->sinking};
    for (int i = 0; i < 3; i++) P[(n + 1) * (foot + i)] += square(more * ways[i]) * time;
    for (int i = 0; i < 3; i++) P[(n + 1) * (sole + i)] += square(more * covariance->rocking) * time;
    if (covariance->on_springs) {
        const double *sprung = covariance->sprung + 3 * k;
        for (int i = 0; i < 3; i++) turned[i] = Z[3 * i] * sprung[0] + Z[3 * i + 1] * sprung[1];
        P[(n + 1) * (foot + 2)] += square(covariance->unsure * sprung[2]);
        for (int i = 0; i < 3; i++) P[(n + 1) * (sole + i)] += square(covariance->unsure * turned[i]);
        filter->columns[3 * (2 + k) + 2] += sprung[2];
        rotation_of(turned, turn);
        compose(turn, Z, seen);
        memcpy(Z, seen, sizeof seen);
    }
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            P[n * (sole + i) + sole + j] += square(covariance->leaning) * time * Z[3 * i] * Z[3 * j];
}

/* Counterpart of `InvariantFilter.spread`. */
void covariance_spread(const Covariance *covariance, double time) {
    const Filter *filter = covariance->filter;
    const int64_t n = filter->size;
    double *P = covariance->P, B[GROUP][3] = {{0.0}};
    Way way = {.time = time, .gravity = filter->gravity, .R = filter->R};
    for (int i = 0; i < 3; i++) B[i][i] = 1.0;
    for (int column = 0; column < 4; column++) {
        const double *at = filter->columns + 3 * column;
        double(*hat)[3] = B + 3 + 3 * column;
        hat[0][1] = -at[2], hat[0][2] = at[1];
        hat[1][0] = at[2], hat[1][2] = -at[0];
        hat[2][0] = -at[1], hat[2][1] = at[0];
    }
    for (int i = 0; i < GROUP; i++) rotate_back(filter->R, B[i], way.turned[i]);
    go_on(&way, P, n, 1, n);
    go_on(&way, P, 1, n, n);
    const double turning = covariance->gyro_density * covariance->gyro_density * time;
    for (int i = 0; i < GROUP; i++)
        for (int j = 0; j < GROUP; j++) {
            double sum = 0.0;
            for (int a = 0; a < 3; a++) sum += B[i][a] * B[j][a];
            P[n * i + j] += turning * sum;
        }
    for (int i = 0; i < 3; i++) {
        P[(n + 1) * (VELOCITY + i)] += covariance->speed_density * time;
        P[(n + 1) * (GYRO + i)] += square(covariance->gyro_walk) * time;
        P[(n + 1) * (FORCE + i)] += square(covariance->force_walk) * time;
    }
    for (int k = 0; k < 2; k++)
        if (covariance->standing[k]) add_foot(covariance, k, time);
}

/* S + noise / ticks factored, from its upper triangle; returns whether it is not positive. */
static int factored(const double *S, const double *noise, int64_t rows, double ticks, double *U) {
    memcpy(U, S, rows * rows * sizeof(double));
    for (int64_t i = 0; i < rows; i++) U[(rows + 1) * i] += noise[i] / ticks;
    return cholesky(U, rows, rows);
}

/* Counterpart of `InvariantFilter.weigh`; returns whether a covariance is not positive, with which nothing is done. */
int64_t covariance_weigh(const Covariance *covariance, double ticks) {
    const Filter *filter = covariance->filter;
    const int64_t n = filter->size, m = n - FIXED, rows = POSE * filter->feet_count;
    const double *R = filter->R;
    double *P = covariance->P, *turned = covariance->turned, *PH = covariance->PH, *HP = covariance->HP;
    double S[MOST * MOST], U[MOST * MOST], V[MOST * MOST], inverse[MOST * MOST], noise[MOST];
    int64_t at[MOST], from[MOST];
    for (int64_t i = 0; i < filter->feet_count; i++) {
        const int64_t k = filter->feet[i];
        const double *J = covariance->jacobian + POSE * m * k;
        for (int a = 0; a < POSE; a++) {
            const int64_t r = POSE * i + a;
            const double own = a < 3 ? covariance->kinematics : covariance->turning;
            at[r] = (a < 3 ? FOOT + 3 * k : SOLE + 3 * k - 3) + a;
            from[r] = a < 3 ? POSITION + a : TURN + a - 3;
            noise[r] = square(own) + square(covariance->encoder) * dot(J + m * a, J + m * a, m - AXES);
            const double *block = J + m * (a < 3 ? 0 : 3), *line = R + 3 * (a % 3);
            for (int64_t j = 0; j < m; j++)
                turned[m * r + j] = line[0] * block[j] + line[1] * block[m + j] + line[2] * block[2 * m + j];
        }
    }
    for (int64_t i = 0; i < n; i++)
        for (int64_t r = 0; r < rows; r++)
            PH[rows * i + r] =
                P[n * i + at[r]] - P[n * i + from[r]] + dot(P + n * i + FIXED, turned + m * r, m);
    for (int64_t r = 0; r < rows; r++)
        for (int64_t s = 0; s < rows; s++) {
            double sum = PH[rows * at[r] + s] - PH[rows * from[r] + s];
            for (int64_t j = 0; j < m; j++) sum += turned[m * r + j] * PH[rows * (FIXED + j) + s];
            S[rows * r + s] = sum;
        }
    if (factored(S, noise, rows, ticks, U) || factored(S, noise, rows, 1.0, V)) return 1;
    for (int64_t i = 0; i < n; i++)
        for (int64_t r = 0; r < rows; r++) HP[n * r + i] = PH[rows * i + r];
    forward_solve(U, rows, rows, HP, n);
    for (int64_t i = 0; i < n; i++) {
        double *row = P + n * i;
        for (int64_t j = i + 1; j < n; j++) row[j] = 0.5 * (row[j] + P[n * j + i]);
        for (int64_t r = 0; r < rows; r++) {
            const double *taken = HP + n * r;
            const double factor = taken[i];
            for (int64_t j = i; j < n; j++) row[j] -= factor * taken[j];
        }
    }
    for (int64_t i = 0; i < n; i++)
        for (int64_t j = i + 1; j < n; j++) P[n * j + i] = P[n * i + j];
    memset(inverse, 0, sizeof inverse);
    for (int64_t r = 0; r < rows; r++) inverse[(rows + 1) * r] = 1.0;
    forward_solve(V, rows, rows, inverse, rows);
    for (int64_t r = 0; r < rows; r++)
        for (int64_t s = r; s < rows; s++) {
            double sum = 0.0;
            for (int64_t a = s; a < rows; a++) sum += inverse[rows * a + r] * inverse[rows * a + s];
            covariance->weights[rows * r + s] = covariance->weights[rows * s + r] = sum;
        }
    for (int64_t i = 0; i < n; i++)
        for (int64_t s = 0; s < rows; s++)
            covariance->gain[rows * i + s] = dot(PH + rows * i, covariance->weights + rows * s, rows);
    return 0;
}
