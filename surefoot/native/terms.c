/* Frame kinematics of the soles and the torso, behind pinocchio.computeAllTerms; see `wbc.model.RobotTerms`. */
#include "algebra.h"
#include "kernels.h"

/* From a wrench in a frame to force and moment about the origin; `stride`: columns of the matrix that has these six. */
static void dual_action(const double *R, const double *p, double *out, int stride) {
    for (int j = 0; j < 3; j++) {
        const double axis[3] = {R[j], R[3 + j], R[6 + j]};
        double lever[3];
        cross(p, axis, lever);
        for (int i = 0; i < 3; i++) {
            out[stride * i + j] = axis[i];
            out[stride * i + 3 + j] = 0.0;
            out[stride * (3 + i) + j] = lever[i];
            out[stride * (3 + i) + 3 + j] = axis[i];
        }
    }
}

/* Counterpart of pinocchio's updateFramePlacement; R is its rotation. */
static void frame_place(const Frame *frame, double *R) {
    double joint[9];
    transpose(frame->joint_rotation_columns, joint);
    compose(joint, frame->placement_rotation, R);
    transpose(R, frame->rotation_columns);
    rotate(joint, frame->placement_position, frame->position);
    for (int i = 0; i < 3; i++) frame->position[i] += frame->joint_position[i];
}

/* Counterpart of pinocchio's updateFramePlacement, getFrameJacobian, getFrameVelocity and classical acceleration. */
static void frame_update(const Terms *terms, const Frame *frame) {
    double R[9], centripetal[3];
    frame_place(frame, R);
    see_motion(frame->placement_rotation, frame->placement_position, frame->joint_velocity, frame->velocity);
    see_motion(frame->placement_rotation, frame->placement_position, frame->joint_acceleration, frame->bias);
    cross(frame->velocity + 3, frame->velocity, centripetal);
    for (int i = 0; i < 3; i++) frame->bias[i] += centripetal[i];

    /* Columns of joints that do not move the frame are zero since Python allocated them. */
    for (int64_t n = 0; n < frame->supporting; n++) {
        const int64_t column = frame->columns[n];
        double seen[6];
        see_motion(R, frame->position, terms->joint_jacobian_columns + 6 * column, seen);
        for (int i = 0; i < 6; i++) frame->jacobian[terms->nv * i + column] = seen[i];
    }
}

/* Where a sole is, of a frame that is in its place. */
static void sole_place(const Sole *sole) {
    transpose(sole->frame->rotation_columns, sole->rotation);
    memcpy(sole->position, sole->frame->position, 3 * sizeof(double));
    memcpy(sole->pose, sole->position, 3 * sizeof(double));
    quaternion(sole->rotation, sole->pose + 3);
}

/* Counterpart of `RobotTerms._update_sole`. */
static void sole_update(const Terms *terms, const Sole *sole) {
    frame_update(terms, sole->frame);
    sole_place(sole);
    memcpy(sole->contact_rotation, sole->rotation, 9 * sizeof(double));
    memcpy(sole->contact_position, sole->position, 3 * sizeof(double));
    dual_action(sole->rotation, sole->position, sole->wrench_map, 12);
}

/* Counterpart of `RobotTerms.update` behind computeAllTerms; returns whether the state is finite. */
int64_t terms_update(const Terms *terms) {
    double sum = 0.0;
    for (int64_t i = 0; i < terms->nq; i++) sum += terms->q[i] * terms->q[i];
    for (int64_t i = 0; i < terms->nv; i++) sum += terms->v[i] * terms->v[i];
    for (int i = 0; i < 3; i++) {
        terms->com_velocity[i] = terms->linear_momentum[i] / terms->model_mass;
        terms->base_angular_velocity[i] = terms->v[3 + i];
    }
    sole_update(terms, terms->left);
    sole_update(terms, terms->right);
    frame_update(terms, terms->torso);
    return isfinite(sum) != 0;
}

/* Counterpart of `RobotTerms.place` behind computeCentroidalMomentum and ccrba: the momentum of the one about the CoM
 * of the other, as computeAllTerms has both. */
void terms_place(const Terms *terms) {
    double turn[3], R[9];
    cross(terms->momentum, terms->com, turn);
    for (int i = 0; i < 3; i++) {
        terms->angular_momentum[i] = terms->momentum[3 + i] + turn[i];
        terms->com_velocity[i] = terms->momentum[i] / terms->model_mass;
    }
    frame_place(terms->left->frame, R);
    frame_place(terms->right->frame, R);
    frame_place(terms->torso, R);
    sole_place(terms->left);
    sole_place(terms->right);
}

/* Counterpart of `RobotTerms.unshift`. */
void terms_unshift(const Terms *terms, int64_t foot) { sole_update(terms, foot ? terms->right : terms->left); }

/* Counterpart of `RobotTerms.shift_foot`, of a sole that does not lean and is not shifted yet. */
void terms_shift(const Terms *terms, int64_t foot, double forward, double pitch) {
    const Sole *sole = foot ? terms->right : terms->left;
    const Frame *frame = sole->frame;
    const double cosine = cos(pitch), sine = sin(pitch);
    const double R[9] = {cosine, 0.0, -sine, 0.0, 1.0, 0.0, sine, 0.0, cosine};
    const double p[3] = {forward, 0.0, 0.0};
    double inner[3], centripetal[3], seen[6], lever[3];

    cross(frame->velocity + 3, p, inner);
    cross(frame->velocity + 3, inner, centripetal);
    for (int64_t n = 0; n < frame->supporting; n++) {
        double *column = frame->jacobian + frame->columns[n], motion[6];
        for (int i = 0; i < 6; i++) motion[i] = column[terms->nv * i];
        see_motion(R, p, motion, seen);
        for (int i = 0; i < 6; i++) column[terms->nv * i] = seen[i];
    }
    see_motion(R, p, frame->velocity, seen);
    memcpy(frame->velocity, seen, sizeof seen);
    see_motion(R, p, frame->bias, seen);
    memcpy(frame->bias, seen, sizeof seen);
    rotate_back(R, centripetal, lever);
    for (int i = 0; i < 3; i++) frame->bias[i] += lever[i];

    rotate(sole->rotation, p, sole->contact_position);
    for (int i = 0; i < 3; i++) sole->contact_position[i] += sole->position[i];
    compose(sole->rotation, R, sole->contact_rotation);
    dual_action(sole->contact_rotation, sole->contact_position, sole->wrench_map, 12);
    dual_action(R, p, terms->to_sole + 36 * foot, 6);
}
