/* Tasks of the whole-body QP and their cost; see `wbc.tasks`. Each writes its own rows, scaled, and its target. */
#include "algebra.h"
#include "kernels.h"

/* The wrench variables of a row. */
static double *wrench_part(const Bench *bench, int row) {
    return bench->rows + bench->variables * row + bench->terms->nv;
}

static void scaled_row(const Bench *bench, int row, const double *jacobian) {
    double *out = bench->rows + bench->variables * row;
    const double scale = bench->scale[row];
    for (int64_t j = 0; j < bench->terms->nv; j++) out[j] = scale * jacobian[j];
}

/* Counterpart of `SupportRegion.project`; an edge is start, unit direction and length. */
static void project(const CentreOfMass *task, double x, double y, double beyond, double *out) {
    const int64_t count = *task->edge_count;
    int inside = 1;
    for (int64_t i = 0; i < count && inside; i++) {
        const double *edge = task->edges + 5 * i;
        inside = (x - edge[0]) * edge[3] - (y - edge[1]) * edge[2] <= 0.0;
    }
    out[0] = x;
    out[1] = y;
    if (inside) return;
    double least = INFINITY;
    for (int64_t i = 0; i < count; i++) {
        const double *edge = task->edges + 5 * i;
        const double along = clamp((x - edge[0]) * edge[2] + (y - edge[1]) * edge[3], 0.0, edge[4]);
        const double px = edge[0] + along * edge[2], py = edge[1] + along * edge[3];
        const double distance = (x - px) * (x - px) + (y - py) * (y - py);
        if (distance < least) {
            out[0] = px;
            out[1] = py;
            least = distance;
        }
    }
    const double share = fmin(1.0, beyond / fmax(sqrt(least), 1e-9));
    out[0] += share * (x - out[0]);
    out[1] += share * (y - out[1]);
}

void task_centre_of_mass(const CentreOfMass *task) {
    const Bench *bench = task->bench;
    const Terms *terms = bench->terms;
    const Reference *wanted = bench->reference;
    const double mass = *terms->mass, per_mass = terms->wrench_unit / mass;
    for (int i = 0; i < 3; i++) {
        const double scale = bench->scale[i] * per_mass;
        double *row = wrench_part(bench, i);
        for (int j = 0; j < 12; j++) row[j] = scale * terms->sole_wrench_map[12 * i + j];
    }
    double point[2], error[2], zmp[2], aim[2];
    for (int i = 0; i < 2; i++) {
        error[i] = terms->com[i] - wanted->com[i];
        const double rate = terms->com_velocity[i] - wanted->com_velocity[i];
        point[i] = wanted->zmp[i] + wanted->zmp_offset[i];
        aim[i] = point[i] + task->dcm * (error[i] + rate / wanted->omega);
    }
    project(task, aim[0], aim[1], wanted->catching != 0.0 ? task->beyond : 0.0, zmp);
    for (int i = 0; i < 2; i++)
        bench->target[i] = wanted->com_acceleration[i] + wanted->stiffness * (point[i] + error[i] - zmp[i]);
    bench->target[2] = wanted->com_acceleration[2] - task->height_stiffness * (terms->com[2] - wanted->com[2]) -
                       task->height_damping * (terms->com_velocity[2] - wanted->com_velocity[2]);
    for (int i = 0; i < 3; i++) bench->target[i] -= terms->load_force[i] / mass;
    bench->target[2] += task->gravity;
}

void task_angular_momentum(const AngularMomentum *task) {
    const Bench *bench = task->bench;
    const Terms *terms = bench->terms;
    const double mass = *terms->mass, scale = bench->scale[0] * (terms->wrench_unit / mass);
    const double x = scale * terms->com[0], y = scale * terms->com[1], z = scale * terms->com[2];
    const double lever[3][3] = {{0.0, z, -y}, {-z, 0.0, x}, {y, -x, 0.0}};
    const double *map = terms->sole_wrench_map;
    for (int i = 0; i < 3; i++) {
        double *row = wrench_part(bench, i);
        for (int j = 0; j < 12; j++)
            row[j] = lever[i][0] * map[j] + lever[i][1] * map[12 + j] + lever[i][2] * map[24 + j] +
                     scale * map[12 * (3 + i) + j];
        bench->target[i] =
            -task->decay / terms->model_mass * terms->angular_momentum[i] - terms->load_moment[i] / mass;
    }
}

/* Counterpart of `angular_acceleration`: K log(R' R_d) - D w + u, in the frame of R. */
static void angular_acceleration(double stiffness, double damping, const double *R, const double *velocity,
                                 const double *desired, const double *ahead, double *out) {
    double turn[9], error[3];
    compose_back(R, desired, turn);
    rotation_vector(turn, error);
    for (int i = 0; i < 3; i++) out[i] = stiffness * error[i] - damping * velocity[i] + ahead[i];
}

/* Counterpart of `_Upright._wanted`. */
static void upright(const Reference *reference, double stiffness, double damping, const double *R,
                    const double *velocity, double *out) {
    const double cosine = cos(reference->heading), sine = sin(reference->heading);
    const double desired[9] = {cosine, -sine, 0.0, sine, cosine, 0.0, 0.0, 0.0, 1.0};
    const double turn = damping * reference->heading_rate;
    const double ahead[3] = {turn * R[6], turn * R[7], turn * R[8]};
    angular_acceleration(stiffness, damping, R, velocity, desired, ahead, out);
}

/* Counterpart of `_beyond`: what of an excess the pelvis takes; `slope` is how that changes with it. */
static double beyond(double excess, double softened, double *slope) {
    if (excess <= -softened) {
        *slope = 0.0;
        return 0.0;
    }
    if (excess >= softened) {
        *slope = 1.0;
        return excess;
    }
    *slope = (excess + softened) / (2.0 * softened);
    return (excess + softened) * (excess + softened) / (4.0 * softened);
}

void task_pelvis(const Pelvis *task) {
    const Bench *bench = task->bench;
    const Terms *terms = bench->terms;
    double R[9], roll = 0.0, rate = 0.0;
    transpose(terms->base_rotation_columns, R);
    for (int i = 0; i < 3; i++) bench->rows[bench->variables * i + 3 + i] = bench->scale[i];
    upright(bench->reference, task->stiffness, task->damping, R, terms->base_angular_velocity, bench->target);
    const double now = atan2(R[7], R[8]);
    for (int64_t i = 0; i < task->hip_count; i++) {
        const double *hip = task->hips + 4 * i;
        const int64_t column = (int64_t)hip[0];
        const double sign = hip[1], lower = hip[2], upper = hip[3];
        const double angle = terms->q[column + 1] + sign * now;
        const int above = angle > 0.5 * (lower + upper);
        double slope;
        const double taken = beyond(above ? angle - upper : lower - angle, task->softened, &slope);
        if (slope != 0.0) {
            roll += (above ? sign : -sign) * taken;
            rate += slope * (sign * terms->v[column] + terms->base_angular_velocity[0]);
        }
    }
    bench->target[0] += task->stiffness * roll + task->damping * rate;
}

void task_torso(const Torso *task) {
    const Bench *bench = task->bench;
    const Terms *terms = bench->terms;
    double R[9];
    transpose(terms->torso->rotation_columns, R);
    for (int i = 0; i < 3; i++) scaled_row(bench, i, terms->torso_jacobian + terms->nv * i);
    upright(bench->reference, task->stiffness, task->damping, R, terms->torso_velocity, bench->target);
    for (int i = 0; i < 3; i++) bench->target[i] -= terms->torso_bias[i];
}

/* Counterpart of `AnkleStops.yielding` for one joint of an ankle: its axis in the sole's frame, and the share. */
static double yielding_share(const SwingFoot *task, int64_t foot, int64_t column, double *axis) {
    const Terms *terms = task->bench->terms;
    const double position = terms->q[column + 1], coming = position + task->ahead * terms->v[column];
    const double up = task->upper[column - 6] - fmax(position, coming);
    const double down = fmin(position, coming) - task->lower[column - 6];
    const double near = fmin(up, down);
    if (near >= task->yielding) return 0.0;
    double turn[9], error[3], onward = 0.0;
    for (int i = 0; i < 3; i++) axis[i] = terms->sole_jacobian[terms->nv * (6 * foot + 3 + i) + column];
    compose_back(terms->contact_rotation + 9 * foot, task->bench->reference->swing_rotation, turn);
    rotation_vector(turn, error);
    for (int i = 0; i < 3; i++) onward += axis[i] * error[i];
    if (!(up < down)) onward = -onward;
    return (1.0 - fmax(0.0, near) / task->yielding) * clamp(1.0 + onward / task->turned_back, 0.0, 1.0);
}

/* Counterpart of `SwingFoot._of_ankle`: the target of the sole's centre made that of the ankle, and its rows. */
static void see_from_ankle(const SwingFoot *task, int64_t foot, const double *R, double *linear) {
    const Bench *bench = task->bench;
    const Terms *terms = bench->terms;
    const Reference *reference = bench->reference;
    const double *ankle = task->ankles + 3 * foot;
    const double *spin = terms->sole_velocity + 6 * foot + 3, *bias = terms->sole_bias + 6 * foot + 3;
    const double *turning = reference->swing_angular_velocity;
    double there[3], here[3], along[3], outward[3], swept[3], wanted[3], local[3], turn[3], moved[3];
    double own[3], ownward[3];
    rotate(reference->swing_rotation, ankle, there);
    rotate(R, ankle, here);
    cross(turning, there, along);
    cross(turning, along, outward);
    cross(reference->swing_angular_acceleration, there, swept);
    for (int i = 0; i < 3; i++)
        wanted[i] = task->stiffness * (there[i] - here[i]) + task->damping * along[i] + swept[i] + outward[i];
    rotate_back(R, wanted, local);
    for (int i = 0; i < 3; i++) turn[i] = task->damping * spin[i] + bias[i];
    cross(turn, ankle, moved);
    cross(spin, ankle, own);
    cross(spin, own, ownward);
    for (int i = 0; i < 3; i++) linear[i] += local[i] - moved[i] - ownward[i];

    const double skew[3][3] = {{0.0, -ankle[2], ankle[1]}, {ankle[2], 0.0, -ankle[0]}, {-ankle[1], ankle[0], 0.0}};
    const double *angular = terms->sole_jacobian + terms->nv * (6 * foot + 3);
    for (int i = 0; i < 3; i++) {
        double *row = bench->rows + bench->variables * i;
        for (int l = 0; l < 3; l++) {
            const double lever = bench->scale[i] * skew[i][l];
            for (int64_t j = 0; j < terms->nv; j++) row[j] -= lever * angular[terms->nv * l + j];
        }
    }
}

/* Takes a share of what turns about a joint's axis out of the angular rows and their target.
   While a step catches the body the joint is to rest instead. */
static void yield(const SwingFoot *task, int64_t column, const double *axis, double share, double *turn) {
    const Bench *bench = task->bench;
    double *rows = bench->rows + 3 * bench->variables, along = 0.0;
    for (int64_t j = 0; j < bench->terms->nv; j++) {
        double part = 0.0;
        for (int i = 0; i < 3; i++) part += axis[i] * rows[bench->variables * i + j];
        for (int i = 0; i < 3; i++) rows[bench->variables * i + j] -= share * axis[i] * part;
    }
    for (int i = 0; i < 3; i++) along += axis[i] * turn[i];
    const double counted = bench->reference->catching ? task->resting : 0.0;
    const double resting = counted * -2.0 * bench->terms->v[column] / task->ahead;
    for (int i = 0; i < 3; i++) {
        rows[bench->variables * i + column] += bench->scale[3 + i] * counted * share * axis[i];
        turn[i] += share * axis[i] * (resting - along);
    }
}

/* `AnkleStops` has the last two joints of a leg, or the last one. */
#define MOST_ANKLE_JOINTS 2

void task_swing_foot(const SwingFoot *task) {
    const Bench *bench = task->bench;
    const Terms *terms = bench->terms;
    const Reference *reference = bench->reference;
    const int64_t foot = (int64_t)reference->swing_foot;
    if (*task->turned != foot) *task->turned = -1;
    if (foot < 0) {
        for (int i = 0; i < 6; i++) {
            bench->target[i] = 0.0;
            memset(bench->rows + bench->variables * i, 0, terms->nv * sizeof(double));
        }
        return;
    }
    const double *R = terms->contact_rotation + 9 * foot, *velocity = terms->sole_velocity + 6 * foot;
    const double *bias = terms->sole_bias + 6 * foot;
    const int rolls = foot == (int64_t)reference->rolling_foot;
    for (int i = 0; i < 6; i++) scaled_row(bench, i, terms->sole_jacobian + terms->nv * (6 * foot + i));

    const int64_t *columns = task->ankle_columns + task->ankle_joints * foot;
    double axes[MOST_ANKLE_JOINTS][3], shares[MOST_ANKLE_JOINTS], most = 0.0;
    for (int64_t n = 0; n < task->ankle_joints; n++) {
        shares[n] = yielding_share(task, foot, columns[n], axes[n]);
        most = fmax(most, shares[n]);
    }
    double wanted[3], ahead[3], turning[3], *linear = bench->target, *turn = bench->target + 3;
    for (int i = 0; i < 3; i++) {
        wanted[i] = reference->swing_position[i] - terms->contact_position[3 * foot + i];
        if (rolls) wanted[i] += task->toe * reference->swing_rotation[3 * i];
        wanted[i] *= task->stiffness;
        wanted[i] += task->damping * reference->swing_velocity[i];
        wanted[i] += reference->swing_acceleration[i];
        turning[i] =
            reference->swing_angular_acceleration[i] + task->damping * reference->swing_angular_velocity[i];
    }
    if (most > 0.0) {
        const double *level = reference->swing_rotation + 6;
        const double beside = reference->catching != 0 ? task->side * fabs(R[7] - level[1]) : 0.0;
        const double hangs = fmin(task->toe * fabs(R[6] - level[0]), task->lifted) + beside;
        wanted[2] += task->stiffness * most * hangs;
    }
    rotate_back(R, wanted, linear);
    rotate_back(R, turning, ahead);
    angular_acceleration(task->stiffness, task->damping, R, velocity + 3, reference->swing_rotation, ahead, turn);
    if (rolls) turn[1] += task->damping * reference->roll[1] + reference->roll[2];
    for (int i = 0; i < 3; i++) {
        linear[i] += -task->damping * velocity[i] - bias[i];
        turn[i] -= bias[3 + i];
    }
    if (most > 0.0) *task->turned = foot;
    if (*task->turned == foot && !rolls) see_from_ankle(task, foot, R, linear);
    for (int64_t n = 0; n < task->ankle_joints; n++)
        if (shares[n] > 0.0) yield(task, columns[n], axes[n], shares[n], turn);
}

/* Counterpart of `ArmSwing.offset`: how far the left arm is swung back, and its rate. */
static void arm_offset(const Posture *term, double *angle, double *rate) {
    const Terms *terms = term->terms;
    const double x = terms->base_rotation_columns[0], y = terms->base_rotation_columns[1];
    const double length = fmax(hypot(x, y), 1e-3), scale = term->arm_gain / length;
    double left[3], right[3];
    rotate(terms->contact_rotation, terms->sole_velocity, left);
    rotate(terms->contact_rotation + 9, terms->sole_velocity + 6, right);
    *angle = scale * (x * (terms->sole_position[0] - terms->sole_position[3]) +
                      y * (terms->sole_position[1] - terms->sole_position[4]));
    *rate = scale * (x * (left[0] - right[0]) + y * (left[1] - right[1]));
}

void cost_posture(const Posture *term) {
    const Terms *terms = term->terms;
    double *joints = term->linear + 6;
    for (int64_t j = 0; j < term->joints; j++)
        joints[j] = term->pull[j] - term->stiffness[j] * terms->q[7 + j] - term->damping[j] * terms->v[6 + j];
    if (term->arm_gain == 0.0) return;
    double angle, rate;
    arm_offset(term, &angle, &rate);
    const int64_t arms[2] = {term->left_arm, term->right_arm};
    const double signs[2] = {term->left_back, -term->right_back};
    for (int i = 0; i < 2; i++)
        joints[arms[i]] += signs[i] * (term->stiffness[arms[i]] * angle + term->damping[arms[i]] * rate);
}

void cost_force_distribution(const ForceDistribution *term) {
    const double weight = term->force * term->terms->wrench_unit * *term->terms->mass * term->gravity;
    double *wrenches = term->linear + term->terms->nv;
    for (int foot = 0; foot < 2; foot++) wrenches[6 * foot + 2] = weight * term->reference->load_share[foot];
}

/* H = T'T + D and g = -(T't + d); the target t becomes the scaled one. */
void stack_assemble(const Stack *stack) {
    const int64_t n = stack->variables;
    double *H = stack->H, *g = stack->g;
    for (int64_t i = 0; i < n; i++) {
        memset(H + n * i, 0, n * sizeof(double));
        g[i] = 0.0;
    }
    for (int64_t row = 0; row < stack->rows_count; row++) {
        const double *T = stack->rows + n * row;
        const double target = stack->target[row] *= stack->scale[row];
        int64_t first = 0, end = n;
        /* Most rows are those of a motion or of the wrenches alone. */
        while (first < n && T[first] == 0.0) first++;
        while (end > first && T[end - 1] == 0.0) end--;
        for (int64_t i = first; i < end; i++) {
            const double factor = T[i];
            if (factor == 0.0) continue;
            double *out = H + n * i;
            for (int64_t j = i; j < end; j++) out[j] += factor * T[j];
        }
        for (int64_t j = first; j < end; j++) g[j] += target * T[j];
    }
    for (int64_t i = 0; i < n; i++) {
        H[n * i + i] += stack->diagonal[i];
        g[i] = -(g[i] + stack->linear[i]);
        for (int64_t j = 0; j < i; j++) H[n * i + j] = H[n * j + i];
    }
}
