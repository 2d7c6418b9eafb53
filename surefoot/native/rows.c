/* Hard rows of the whole-body QP; see `wbc.dynamics`, `wbc.limits` and `wbc.separation`. */
#include "algebra.h"
#include "kernels.h"

/* Counterpart of `HardConstraints._motion`. */
static void motion(const HardRows *rows) {
    const Terms *terms = rows->terms;
    const int64_t n = rows->variables, nv = terms->nv;
    for (int64_t i = 0; i < nv; i++) {
        double *row = rows->A + n * (12 + i);
        memcpy(row, terms->mass_matrix + nv * i, nv * sizeof(double));
        for (int j = 0; j < 12; j++) row[nv + j] = -terms->wrench_unit * terms->sole_jacobian[nv * j + i];
        rows->lower[n + 12 + i] = -terms->bias[i] - rows->torque_span[i];
        rows->upper[n + 12 + i] = -terms->bias[i] + rows->torque_span[i];
    }
}

/* Counterpart of `HardConstraints._contacts` for one foot: its six equalities. It is held where active is not 0, and
 * lands where that is 2. */
static void contact(const HardRows *rows, int64_t foot, int active, int rolls) {
    const Terms *terms = rows->terms;
    const Reference *reference = rows->reference;
    const int64_t n = rows->variables, nv = terms->nv, first = 6 * foot;
    double target[6] = {0.0};
    for (int i = 0; i < 6; i++) {
        double *row = rows->A + n * (first + i);
        memset(row, 0, n * sizeof(double));
        const int free_of_motion = !active || (rows->leaning && i == rows->free_row);
        if (free_of_motion)
            row[nv + first + i] = 1.0;
        else
            memcpy(row, terms->sole_jacobian + nv * (first + i), nv * sizeof(double));
    }
    if (active) {
        /* Rotation vector, in the sole frame, that turns the sole's normal to the ground's. */
        double normal[3];
        rotate_back(terms->contact_rotation + 9 * foot, reference->ground_normal + 3 * foot, normal);
        for (int i = 0; i < 6; i++)
            target[i] = terms->sole_velocity[first + i] * -rows->damping - terms->sole_bias[first + i];
        if (active == 2) {
            const double off = terms->sole_velocity[first + 2] + rows->sinking;
            target[2] = -rows->softening * off - terms->sole_bias[first + 2];
        }
        target[3] -= rows->levelling * normal[1];
        target[4] += rows->levelling * normal[0];
        if (rolls) target[4] += rows->damping * reference->roll[1] + reference->roll[2];
        if (rows->leaning) target[rows->free_row] = 0.0;
    }
    memcpy(rows->lower + n + first, target, sizeof target);
    memcpy(rows->upper + n + first, target, sizeof target);
}

/* Counterpart of `AccelerationBounds.write`, with a foot that is held counted as at rest. */
static void joint_bounds(const HardRows *rows, const int64_t *held) {
    const Terms *terms = rows->terms;
    const int64_t nv = terms->nv, joints = nv - 6;
    memcpy(rows->rates, terms->v, nv * sizeof(double));
    for (int64_t foot = 0; foot < 2; foot++)
        for (int64_t n = 0; held[foot] && n < rows->ankle_joints; n++) {
            const int64_t column = rows->ankle_columns[rows->ankle_joints * foot + n];
            double turning = 0.0;
            for (int64_t i = 6 * foot + 3; i < 6 * foot + 6; i++)
                turning += terms->sole_velocity[i] * terms->sole_jacobian[nv * i + column];
            rows->rates[column] -= turning;
        }
    for (int64_t j = 0; j < joints; j++) {
        const double velocity = rows->rates[6 + j], reach = velocity * rows->reach_time + terms->q[7 + j];
        const double lowest = (rows->positions[j] - reach) * rows->position_rate;
        const double highest = (rows->positions[joints + j] - reach) * rows->position_rate;
        const double slowest = (rows->velocities[j] - velocity) * rows->velocity_rate;
        const double fastest = (rows->velocities[joints + j] - velocity) * rows->velocity_rate;
        const double lower = lowest > slowest ? lowest : slowest, upper = highest < fastest ? highest : fastest;
        rows->lower[6 + j] = lower < highest ? lower : highest;
        rows->upper[6 + j] = upper > lowest ? upper : lowest;
    }
    for (int64_t foot = 0; foot < 2; foot++)
        if (held[foot] && rows->tipping_columns[foot] >= 0) {
            rows->lower[rows->tipping_columns[foot]] = -rows->unbounded;
            rows->upper[rows->tipping_columns[foot]] = rows->unbounded;
        }
}

/* Counterpart of `HardConstraints.write`, but for the wrench cones, which change with the contacts only. */
void hard_rows_write(const HardRows *rows, int64_t left, int64_t right, int64_t rolling, double left_cap,
                     double right_cap) {
    const double unit = rows->terms->wrench_unit;
    const int64_t nv = rows->terms->nv;
    const int64_t held[2] = {left && rolling != 0, right && rolling != 1};
    motion(rows);
    contact(rows, 0, (int)left, rolling == 0);
    contact(rows, 1, (int)right, rolling == 1);
    rows->upper[nv + 2] = left_cap / unit;
    rows->upper[nv + 8] = right_cap / unit;
    joint_bounds(rows, held);
}

/* Tasks, their cost and the hard rows in one call; returns how many pairs of limbs are due to be measured. */
int64_t qp_build(const QpBuild *build, int64_t left, int64_t right, int64_t rolling, double left_cap,
                 double right_cap) {
    calls_run(build->tasks);
    hard_rows_write(build->hard, left, right, rolling, left_cap, right_cap);
    return pairs_due(build->pairs);
}

/* Adds n'(J v) of a point of a body; the columns are those of the joints that move it. */
static void add_point(const Distance *distance, double sign, const double *normal, const double *point, int64_t count,
                      const int64_t *columns) {
    double lever[3];
    cross(point, normal, lever);
    for (int64_t n = 0; n < count; n++) {
        const double *column = distance->terms->joint_jacobian_columns + 6 * columns[n];
        double rate = 0.0;
        for (int i = 0; i < 3; i++) rate += normal[i] * column[i] + lever[i] * column[3 + i];
        distance->gradient[columns[n]] += sign * rate;
    }
}

/* Fills the gradient of a distance; returns its rate. `points`: point a, point b. */
double distance_rate(const Distance *distance) {
    const double normal[3] = {-distance->direction[0], -distance->direction[1], -distance->direction[2]};
    const int64_t nv = distance->terms->nv;
    memset(distance->gradient, 0, nv * sizeof(double));
    add_point(distance, 1.0, normal, distance->points, distance->first_count, distance->first_columns);
    add_point(distance, -1.0, normal, distance->points + 3, distance->second_count, distance->second_columns);
    return dot(distance->gradient, distance->terms->v, nv);
}

/* Counterpart of `wbc.balance.SupportRegion.rebuild`. */
void support_rebuild(const Support *support, int64_t left, int64_t right, int64_t rolling) {
    const int64_t active[2] = {left, right};
    double points[8][2], vertices[18][2];
    int64_t count = 0;
    for (int64_t k = 0; k < 2; k++)
        for (int64_t i = 0; active[k] && i < 4; i++) {
            const double *corner = support->corners + 2 * i, *R = support->rotations + 9 * k;
            const double x = k == rolling ? 0.0 : corner[0];
            for (int j = 0; j < 2; j++)
                points[count][j] = support->positions[3 * k + j] + (x * R[3 * j] + corner[1] * R[3 * j + 1]);
            count++;
        }
    const int64_t edges = hull(points, count, vertices);
    support->edge_count[0] = edges;
    for (int64_t k = 0; k < edges; k++) {
        const double *start = vertices[k], *end = vertices[(k + 1) % edges];
        const double x = end[0] - start[0], y = end[1] - start[1], length = hypot(x, y);
        const double edge[5] = {start[0], start[1], x / length, y / length, length};
        memcpy(support->edges + 5 * k, edge, sizeof edge);
    }
}
