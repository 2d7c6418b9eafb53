/* Vectors of three numbers and rotations, which are nine numbers row by row unless a name says "columns". */
#ifndef SUREFOOT_ALGEBRA_H
#define SUREFOOT_ALGEBRA_H

#include <math.h>
#include <stdint.h>
#include <string.h>

static inline void cross(const double *a, const double *b, double *out) {
    out[0] = a[1] * b[2] - a[2] * b[1];
    out[1] = a[2] * b[0] - a[0] * b[2];
    out[2] = a[0] * b[1] - a[1] * b[0];
}

/* R x */
static inline void rotate(const double *R, const double *x, double *out) {
    for (int i = 0; i < 3; i++) out[i] = R[3 * i] * x[0] + R[3 * i + 1] * x[1] + R[3 * i + 2] * x[2];
}

/* R' x */
static inline void rotate_back(const double *R, const double *x, double *out) {
    for (int i = 0; i < 3; i++) out[i] = R[i] * x[0] + R[3 + i] * x[1] + R[6 + i] * x[2];
}

/* A B, of two rotations */
static inline void compose(const double *A, const double *B, double *out) {
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            out[3 * i + j] = A[3 * i] * B[j] + A[3 * i + 1] * B[3 + j] + A[3 * i + 2] * B[6 + j];
}

/* A' B, of two rotations */
static inline void compose_back(const double *A, const double *B, double *out) {
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) out[3 * i + j] = A[i] * B[j] + A[3 + i] * B[3 + j] + A[6 + i] * B[6 + j];
}

static inline void transpose(const double *R, double *out) {
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) out[3 * j + i] = R[3 * i + j];
}

/* a x + b y + c z, rounded once a term, as the library that numpy asks has it on processors that fuse. */
static inline double fused_sum(double a, double x, double b, double y, double c, double z) {
    return fma(c, z, fma(b, y, a * x));
}

/* A B, likewise. */
static inline void fused_compose(const double *A, const double *B, double *out) {
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            out[3 * i + j] = fused_sum(A[3 * i], B[j], A[3 * i + 1], B[3 + j], A[3 * i + 2], B[6 + j]);
}

/* A motion (linear, angular) seen from a frame with rotation R and origin p. */
static inline void see_motion(const double *R, const double *p, const double *motion, double *out) {
    double lever[3], linear[3];
    cross(p, motion + 3, lever);
    for (int i = 0; i < 3; i++) linear[i] = motion[i] - lever[i];
    rotate_back(R, linear, out);
    rotate_back(R, motion + 3, out + 3);
}

/* Rotation by a rotation vector, as pinocchio.exp3 has it. */
static inline void rotation_of(const double *x, double *R) {
    const double square = x[0] * x[0] + x[1] * x[1] + x[2] * x[2], angle = sqrt(square);
    const int small = angle < 1e-4;
    const double first = small ? 1.0 - square / 6.0 : sin(angle) / angle;
    const double half = sin(0.5 * angle);
    const double second = small ? 0.5 - square / 24.0 : 2.0 * half * half / square;
    const double cosine = 1.0 - second * square;
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) R[3 * i + j] = second * x[i] * x[j] + (i == j ? cosine : 0.0);
    R[1] -= first * x[2];
    R[2] += first * x[1];
    R[3] += first * x[2];
    R[5] -= first * x[0];
    R[6] -= first * x[1];
    R[7] += first * x[0];
}

/* Rotation vector of a rotation, as pinocchio.log3 has it for angles below pi. */
static inline void rotation_vector(const double *R, double *out) {
    const double axis[3] = {R[7] - R[5], R[2] - R[6], R[3] - R[1]};
    const double sine = 0.5 * sqrt(axis[0] * axis[0] + axis[1] * axis[1] + axis[2] * axis[2]);
    const double cosine = 0.5 * (R[0] + R[4] + R[8] - 1.0);
    const double scale = sine < 1e-8 ? 0.5 : 0.5 * atan2(sine, cosine) / sine;
    for (int i = 0; i < 3; i++) out[i] = scale * axis[i];
}

/* Quaternion x y z w of a rotation, as Eigen has it, and with it pinocchio.SE3ToXYZQUAT. */
static inline void quaternion(const double *R, double *out) {
    const double trace = R[0] + R[4] + R[8];
    if (trace > 0.0) {
        double root = sqrt(trace + 1.0);
        out[3] = 0.5 * root;
        root = 0.5 / root;
        out[0] = (R[7] - R[5]) * root;
        out[1] = (R[2] - R[6]) * root;
        out[2] = (R[3] - R[1]) * root;
        return;
    }
    int i = R[4] > R[0] ? 1 : 0;
    if (R[8] > R[4 * i]) i = 2;
    const int j = (i + 1) % 3, k = (j + 1) % 3;
    double root = sqrt(R[4 * i] - R[4 * j] - R[4 * k] + 1.0);
    out[i] = 0.5 * root;
    root = 0.5 / root;
    out[3] = (R[3 * k + j] - R[3 * j + k]) * root;
    out[j] = (R[3 * j + i] + R[3 * i + j]) * root;
    out[k] = (R[3 * k + i] + R[3 * i + k]) * root;
}

/* Four sums beside each other, in this order on every machine: one alone would wait for itself at each term. */
static inline double dot(const double *a, const double *b, int64_t count) {
    double sums[4] = {0.0};
    int64_t i = 0;
    for (; i + 4 <= count; i += 4)
        for (int lane = 0; lane < 4; lane++) sums[lane] += a[i + lane] * b[i + lane];
    for (int lane = 0; i + lane < count; lane++) sums[lane] += a[i + lane] * b[i + lane];
    return (sums[0] + sums[1]) + (sums[2] + sums[3]);
}

static inline double clamp(double value, double least, double most) {
    return value < least ? least : value > most ? most : value;
}

/* Twice the area of a triangle, positive where the way from a by b to c turns left. */
static inline double left_turn(const double *a, const double *b, const double *c) {
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
}

/* Anticlockwise hull of a few points by Andrew's monotone chain; sorts them. Returns how many vertices there are. */
static inline int64_t hull(double (*points)[2], int64_t count, double (*vertices)[2]) {
    int64_t found = 0;
    for (int64_t k = 1; k < count; k++)
        for (int64_t i = k; i > 0; i--) {
            double *a = points[i - 1], *b = points[i];
            if (a[0] < b[0] || (a[0] == b[0] && a[1] <= b[1])) break;
            const double swapped[2] = {a[0], a[1]};
            memcpy(a, b, sizeof swapped);
            memcpy(b, swapped, sizeof swapped);
        }
    for (int upper = 0; upper < 2; upper++) {
        const int64_t first = found;
        for (int64_t k = 0; k < count; k++) {
            const double *point = points[upper ? count - 1 - k : k];
            while (found >= first + 2 && left_turn(vertices[found - 2], vertices[found - 1], point) <= 0.0) found--;
            memcpy(vertices[found++], point, sizeof *points);
        }
        found--; /* The last one begins the other half. */
    }
    return found;
}

#endif
