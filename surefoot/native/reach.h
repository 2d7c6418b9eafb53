/* What legs can do to catch a body; see `planner.swing.leg_reach`. */
#ifndef SUREFOOT_REACH_H
#define SUREFOOT_REACH_H

#include "algebra.h"
#include "kernels.h"

static const double peak = 5.77, braking = 1.9, gaining = 3.9; /* of `planner.swing.leg_reach` */

enum { BOXES = 3 };

/* Lower and upper corner of where a foot may land, then whether it is empty. */
typedef struct {
    double low[2];
    double high[2];
    int64_t empty;
} Box;

/* Counterpart of `planner.swing.leg_reach.LegReach.allowed` of legs that are turned; says how many boxes there are. */
static inline int64_t allowed(const Legs *legs, const Landing *step, Box *boxes) {
    const double most = legs->stride, far = step->side * (most + legs->hip_width);
    const double back[BOXES] = {-most, step->clear, -most}, ahead[BOXES] = {most, most, -step->clear};
    const int64_t count = step->crosses != 0.0 && legs->crosses ? BOXES : 1;
    for (int64_t b = 0; b < count; b++) {
        const double near = step->side * (b ? -legs->across : step->near);
        boxes[b].low[0] = fmax(back[b], step->face[0]);
        boxes[b].low[1] = fmax(fmin(near, far), step->face[1]);
        boxes[b].high[0] = fmin(ahead[b], step->face[2]);
        boxes[b].high[1] = fmin(fmax(near, far), step->face[3]);
        boxes[b].empty = boxes[b].low[0] > boxes[b].high[0] || boxes[b].low[1] > boxes[b].high[1];
    }
    return count;
}

static inline double swing_time(const Legs *legs, double single) {
    return fmax(single - legs->touchdown_lead, legs->sample_time);
}

/* Counterpart of `planner.swing.leg_reach.LegReach.edges`, for one time left of the swing. */
static inline void swung_to(const Legs *legs, const Landing *step, double single, double *edges) {
    const double time = swing_time(legs, single), usual = swing_time(legs, step->single_left);
    for (int i = 0; i < 2; i++) {
        const double at = step->swing[i], speed = step->swing[2 + i];
        const double nominal = peak * (step->nominal[i] - at) / (usual * usual) - braking * speed / usual;
        const double hardest = fmax(legs->acceleration[i], fabs(nominal));
        for (int back = 0; back < 2; back++) {
            const double side = back ? -1.0 : 1.0, onward = side * speed;
            const double gained = (onward > 0.0 ? braking : gaining) * onward;
            edges[2 * back + i] = side * at + (hardest * time * time + gained * time) / peak;
        }
    }
}

#endif
