/* Pairs of shapes that can have come near each other; see `wbc.separation`. */
#include "algebra.h"
#include "kernels.h"

static const double *at(int64_t address) { return (const double *)(intptr_t)address; }

/* Where the second body's shape is, seen from the first body: rotation, then centre; Pinocchio's lie by columns. */
static void see(const int64_t *pose, const double *centre, double *place) {
    const double *first = at(pose[0]), *second = at(pose[2]);
    double lever[3];
    for (int i = 0; i < 3; i++) {
        lever[i] = at(pose[3])[i] - at(pose[1])[i];
        for (int j = 0; j < 3; j++) lever[i] += second[3 * j + i] * centre[j];
    }
    for (int i = 0; i < 3; i++) {
        const double *axis = first + 3 * i;
        for (int j = 0; j < 3; j++)
            place[3 * i + j] = axis[0] * second[3 * j] + axis[1] * second[3 * j + 1] + axis[2] * second[3 * j + 2];
        place[9 + i] = axis[0] * lever[0] + axis[1] * lever[1] + axis[2] * lever[2];
    }
}

/*
 * Writes the numbers of the pairs whose distance may be less than the attention; returns how many they are.
 *
 * A distance changes by no more than a point of the second shape moves, seen from the first: its centre, and as far
 * as the farthest point from that turns. What is told to be due is taken as measured in this place.
 */
int64_t pairs_due(const Pairs *pairs) {
    int64_t found = 0;
    for (int64_t k = 0; k < pairs->count; k++) {
        double place[12], turned = 0.0, moved = 0.0, *measured = pairs->places + 12 * k;
        see(pairs->poses + 4 * k, pairs->centres + 3 * k, place);
        for (int i = 0; i < 12; i++) {
            const double change = place[i] - measured[i];
            *(i < 9 ? &turned : &moved) += change * change;
        }
        const double most = sqrt(moved) + pairs->radii[k] * sqrt(0.5 * turned);
        if (pairs->distances[k] - most > pairs->attention) continue;
        memcpy(measured, place, sizeof place);
        pairs->due[found++] = k;
    }
    return found;
}
