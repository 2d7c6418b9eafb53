/* Sole wrenches from the torques of the joints; see `wbc.estimation.torques`. */
#include "algebra.h"
#include "kernels.h"

enum { POSE = 6, WRENCHES = 12 };

/* Counterpart of the residual in `TorqueWrench.update`, a share of which follows in a span; at first all of it. */
static void observe(const TorqueWrench *torques, double span, double share) {
    const int64_t nv = torques->nv;
    for (int64_t i = 0; i < nv; i++) {
        const double momentum = dot(torques->M + nv * i, torques->v, nv);
        const double driven = dot(torques->C_columns + nv * i, torques->v, nv) - torques->gravity[i];
        const double torque = i < POSE ? 0.0 : torques->torque[i - POSE];
        double *residual = torques->residual + i;
        if (span > 0.0) {
            const double acted = i < POSE || torques->held ? torque : 0.5 * (torque + torques->last_torque[i - POSE]);
            const double lacking = (momentum - torques->momentum[i]) / span - 0.5 * (driven + torques->driven[i]);
            *residual += share * (lacking - acted - *residual);
        } else {
            *residual = -driven - torque;
        }
        torques->momentum[i] = momentum;
        torques->driven[i] = driven;
    }
    memcpy(torques->last_torque, torques->torque, (nv - POSE) * sizeof(double));
}

/* Transposed Jacobian of both soles in their frames, of the rows that move one, with moments counted as forces. */
static void see_soles(const TorqueWrench *torques, double *A) {
    double joint[9], R[9], p[3], motion[POSE];
    for (int k = 0; k < 2; k++) {
        const SensedSole *sole = k ? torques->right : torques->left;
        transpose(sole->joint_rotation_columns, joint);
        compose(joint, sole->placement_rotation, R);
        rotate(joint, sole->placement_position, p);
        for (int i = 0; i < 3; i++) p[i] += sole->joint_position[i];
        for (int64_t r = 0; r < torques->count; r++) {
            const int64_t row = torques->rows[r];
            see_motion(R, p, torques->joint_jacobian_columns + POSE * row, motion);
            for (int i = 0; i < POSE; i++)
                A[WRENCHES * r + POSE * k + i] =
                    torques->supporting[torques->nv * k + row] * torques->scale[POSE * k + i] * motion[i];
        }
    }
}

/* No wrench, as of a state that is not finite. */
static void know_nothing(const TorqueWrench *torques) {
    for (int a = 0; a < WRENCHES; a++) torques->wrench[a] = torques->deviation[a] = NAN;
}

/* Counterpart of `TorqueWrench.update`, of a span or at first. */
void torque_wrench_update(const TorqueWrench *torques, double span, double share) {
    const int64_t nv = torques->nv, m = torques->count;
    double *noise = torques->noise, *A = torques->A, *some = torques->some, *seen = torques->seen;
    double normal[WRENCHES * WRENCHES] = {0.0}, spread[WRENCHES * WRENCHES] = {0.0}, y[WRENCHES] = {0.0};
    /* The upper triangle of columns is the lower one of rows. */
    for (int64_t i = 0; i < nv; i++)
        for (int64_t j = 0; j < i; j++) torques->M[i + nv * j] = torques->M[j + nv * i];
    observe(torques, span, share);
    see_soles(torques, A);
    for (int64_t r = 0; r < m; r++) {
        const double *row = torques->M + nv * torques->rows[r];
        for (int64_t j = 0; j < nv; j++) some[j] = torques->velocity_noise[j] * row[j];
        for (int64_t s = r; s < m; s++) noise[m * r + s] = dot(some, torques->M + nv * torques->rows[s], nv);
        seen[r] = torques->residual[torques->rows[r]];
    }
    for (int64_t r = 0; r < m; r++)
        noise[(m + 1) * r] += torques->rows[r] < POSE ? torques->base_noise : torques->torque_noise;
    if (cholesky(noise, m, m)) {
        know_nothing(torques);
        return;
    }
    forward_solve(noise, m, m, A, WRENCHES);
    forward_solve(noise, m, m, seen, 1);
    for (int64_t r = 0; r < m; r++)
        for (int a = 0; a < WRENCHES; a++) {
            y[a] += A[WRENCHES * r + a] * seen[r];
            for (int b = a; b < WRENCHES; b++) normal[WRENCHES * a + b] += A[WRENCHES * r + a] * A[WRENCHES * r + b];
        }
    for (int a = 0; a < WRENCHES; a++) {
        normal[(WRENCHES + 1) * a] += torques->least;
        spread[(WRENCHES + 1) * a] = 1.0;
    }
    if (cholesky(normal, WRENCHES, WRENCHES)) {
        know_nothing(torques);
        return;
    }
    forward_solve(normal, WRENCHES, WRENCHES, spread, WRENCHES);
    forward_solve(normal, WRENCHES, WRENCHES, y, 1);
    for (int a = 0; a < WRENCHES; a++) {
        double variance = 0.0, found = 0.0;
        for (int r = a; r < WRENCHES; r++) {
            variance += spread[WRENCHES * r + a] * spread[WRENCHES * r + a];
            found += spread[WRENCHES * r + a] * y[r];
        }
        torques->wrench[a] = torques->scale[a] * found;
        torques->deviation[a] = torques->scale[a] * sqrt(variance);
    }
}
