/* What a plan sees of the walk ahead: phases, ZMP reference, CoM height, stiffness and the frequency of its DCM. */
#include "algebra.h"
#include "kernels.h"

static const double rounding = 1e-9; /* CLOCK_ROUNDING */
static const double pi = 3.14159265358979323846;

enum { DOUBLE = 1, SINGLE = 2 };
enum { COLUMNS = 7 };

/* Counterpart of `planner.model.time_scaling.TimeScaling._followed`, its rate and bend with the clock. */
static void follow(const double *course, double ahead, double *clock, double *rate, double *bend) {
    const double begun = course[0], length = course[2], *c = course + 3;
    const double time = course[1] + ahead, t = clamp(time, 0.0, length);
    *clock = begun + c[0] + t * (c[1] + t * (c[2] + t * (c[3] + t * (c[4] + t * c[5])))) + (time - t);
    *rate = 1.0;
    *bend = 0.0;
    if (time > length) return;
    *rate = c[1] + t * (2.0 * c[2] + t * (3.0 * c[3] + t * (4.0 * c[4] + t * 5.0 * c[5])));
    *bend = 2.0 * c[2] + t * (6.0 * c[3] + t * (12.0 * c[4] + t * 20.0 * c[5]));
}

static void look_up_clock(const Preview *preview, int64_t steady, double now) {
    for (int64_t k = 0; k < preview->samples; k++) {
        const double ahead = (double)k - 1.0;
        if (steady) {
            preview->clock[k] = fmax(now + ahead, 0.0);
        } else {
            follow(preview->course, ahead, preview->clock + k, preview->rate + k, preview->bend + k);
            preview->bend[k] /= preview->sample_time;
        }
    }
}

/* Counterpart of `planner.steps.phases.PhaseSamples.of`. */
static void look_up_phases(const Preview *preview) {
    const Sight *sight = preview->sight;
    int64_t which = 0;
    for (int64_t k = 0; k < preview->samples; k++) {
        while (which + 1 < sight->phases && sight->start[which + 1] <= preview->clock[k] + rounding) which++;
        const double rest = sight->rest[which], elapsed = fmax(preview->clock[k] - sight->start[which], 0.0);
        const double ramp = sight->kind[which] == DOUBLE ? sight->length[which] - rest : INFINITY;
        const double gone = elapsed - rest;
        preview->which[k] = which;
        preview->kind[k] = sight->kind[which];
        preview->index[k] = sight->support[which] - sight->first;
        preview->contacts[2 * k] = sight->contacts[2 * which];
        preview->contacts[2 * k + 1] = sight->contacts[2 * which + 1];
        preview->elapsed[k] = elapsed;
        preview->length[k] = sight->length[which];
        preview->fraction[k] = fmax(gone / ramp, 0.0);
        preview->fraction_rate[k] = gone >= 0.0 ? 1.0 / (ramp * preview->sample_time) : 0.0;
    }
}

/* Counterpart of `planner.references.zmp_reference._inscribed_boxes`, of one step. */
static void inscribed_box(const double *half_size, double yaw, double *box) {
    const double a = half_size[0], b = half_size[1], c = fabs(cos(yaw)), s = fabs(sin(yaw));
    const double scale = fmin(a / (a * c + b * s), b / (a * s + b * c));
    box[0] = scale * a;
    box[1] = scale * b;
}

/* Counterpart of `planner.references.zmp_reference._joint_boxes`, of one pair of feet. */
static void join_boxes(double x, double y, double *box) {
    const double a = box[0], b = box[1], most = fmax(2.0 * x * y, 1e-12);
    const double sideways = clamp((a * y - b * x) / most, 0.0, 1.0), ahead = clamp((b * x - a * y) / most, 0.0, 1.0);
    const double wide[2] = {a - sideways * x, b + sideways * y}, along[2] = {a + ahead * x, b - ahead * y};
    memcpy(box, wide[0] * wide[1] >= along[0] * along[1] ? wide : along, sizeof wide);
}

/* Counterpart of `surefoot.polygon.convex_hull`, of the corners of two soles; sorts them. */
static int64_t hull_of_soles(double (*points)[2], double (*vertices)[2], double flat, double rounding) {
    double low[2] = {INFINITY, INFINITY}, high[2] = {-INFINITY, -INFINITY};
    int64_t count = hull(points, 8, vertices), corner = 0;
    for (int64_t k = 0; k < 8; k++)
        for (int i = 0; i < 2; i++) low[i] = fmin(low[i], points[k][i]), high[i] = fmax(high[i], points[k][i]);
    const double extent = fmax(high[0] - low[0], high[1] - low[1]);
    const double far = fmax(fmax(fabs(high[0]), fabs(low[0])), fmax(fabs(high[1]), fabs(low[1])));
    const double least = extent * (flat * extent + rounding * far);
    while (corner < count) {
        const double *before = vertices[corner ? corner - 1 : count - 1], *after = vertices[(corner + 1) % count];
        if (left_turn(before, vertices[corner], after) > least) {
            corner++;
            continue;
        }
        memmove(vertices + corner, vertices + corner + 1, (count - 1 - corner) * sizeof *vertices);
        count--;
        corner = corner > 1 ? corner - 1 : 0;
    }
    return count;
}

void sole_hulls_find(const SoleHulls *soles) {
    double points[8][2], vertices[18][2];
    for (int64_t k = 0; k < 2; k++) {
        memcpy(points, soles->corners + 16 * k, sizeof points);
        soles->counts[k] = hull_of_soles(points, vertices, soles->flat, soles->rounding);
        memcpy(soles->hulls + 16 * k, vertices, soles->counts[k] * sizeof *vertices);
    }
}

void support_table_fill(const SupportTable *table) {
    const double *origin = table->positions + 3 * table->stance, yaw = table->yaws[table->stance];
    const double c = cos(yaw), s = sin(yaw);
    for (int64_t r = 0; r < table->points; r++) {
        const int64_t feet[2] = {table->supports[2 * r], table->supports[2 * r + 1]};
        const double *one = table->positions + 3 * feet[0], *other = table->positions + 3 * feet[1];
        const double x = 0.5 * (one[0] + other[0]) - origin[0], y = 0.5 * (one[1] + other[1]) - origin[1];
        double *row = table->values + COLUMNS * r, box[2][2];
        row[0] = x * c + y * s;
        row[1] = y * c - x * s;
        for (int64_t j = 0; j < 2; j++) {
            const int64_t moved = table->stance + 1 + j;
            double shifted = 0.0;
            for (int i = 0; i < 2; i++)
                shifted += (table->stay ? feet[i] == moved : feet[i] >= moved) ? table->free[j] : 0.0;
            row[2 + j] = 0.5 * shifted;
        }
        for (int i = 0; i < 2; i++) inscribed_box(table->half_size, table->yaws[feet[i]] - yaw, box[i]);
        for (int i = 0; i < 2; i++) row[4 + i] = 0.5 * (box[0][i] + box[1][i]);
        if (feet[0] != feet[1]) {
            const double dx = other[0] - one[0], dy = other[1] - one[1];
            join_boxes(0.5 * fabs(dx * c + dy * s), 0.5 * fabs(dy * c - dx * s), row + 4);
        }
        row[6] = 0.5 * (one[2] + other[2]);
    }
    memset(table->steps + COLUMNS * (table->points - 1), 0, COLUMNS * sizeof(double));
    for (int64_t i = 0; i < COLUMNS * (table->points - 1); i++)
        table->steps[i] = table->values[COLUMNS + i] - table->values[i];
}

/* Counterpart of `planner.references.zmp_reference.zmp_reference` and `load_left`, from the second sample on. */
static void refer(const Preview *preview) {
    const Sight *sight = preview->sight;
    const double *values = sight->values, *steps = sight->steps;
    for (int64_t k = 1; k + 1 < preview->samples; k++) {
        const int64_t index = preview->index[k], next = index + 1 < sight->points ? index + 1 : index, at = k - 1;
        const double share = preview->fraction[k];
        double row[COLUMNS];
        for (int i = 0; i < COLUMNS; i++) row[i] = values[COLUMNS * index + i] + share * steps[COLUMNS * index + i];
        memcpy(preview->point + 2 * at, row, 2 * sizeof(double));
        memcpy(preview->gain + 2 * at, row + 2, 2 * sizeof(double));
        memcpy(preview->half_size + 2 * at, row + 4, 2 * sizeof(double));
        preview->ground[at] = row[6];
        preview->load_left[at] = (1.0 - share) * sight->on_left[index] + share * sight->on_left[next];
    }
}

/* Counterpart of `planner.references.com_height.quintic_rise`. */
static void rise_to(double s, double rate, double *rise) {
    const double left = 1.0 - s;
    rise[0] = s * s * s * (10.0 - 15.0 * s + 6.0 * s * s);
    rise[1] = 30.0 * s * s * left * left * rate;
    rise[2] = 60.0 * s * left * (1.0 - 2.0 * s) * rate * rate;
}

static double level_at(const Sight *sight, int64_t at, int64_t lower) {
    const double here = sight->heights[at];
    return lower && at + 1 < sight->points ? fmin(here, sight->heights[at + 1]) : here;
}

/* Counterpart of `planner.references.com_height.SmoothHeight.height`, from the second sample on. */
static void lift(const Preview *preview, int64_t steady) {
    const Sight *sight = preview->sight;
    const int64_t count = preview->samples - 2, early = preview->early;
    const double t = preview->sample_time;
    for (int64_t k = 1; k <= count; k++) {
        const double elapsed = preview->elapsed[k], length = preview->length[k];
        const double apex = preview->apexes[preview->kind[k]], w = pi / (length * t), angle = pi * elapsed / length;
        const double s = sin(angle), c = cos(angle);
        double z[3] = {apex * s * s * s, apex * 3.0 * w * s * s * c, apex * 3.0 * w * w * s * (2.0 * c * c - s * s)};
        double rise[3];
        const int64_t swinging = preview->kind[k] == SINGLE;
        int64_t index = preview->index[k];
        if (early && index > 0 && (swinging || isinf(length))) index--;
        const double level = level_at(sight, index, early);
        const double step = index + 1 < sight->points ? level_at(sight, index + 1, early) - level : 0.0;
        if (!early) {
            rise_to(preview->fraction[k], preview->fraction_rate[k], rise);
        } else {
            const double within = swinging ? preview->early_shares[step < 0.0] * length : INFINITY;
            const double share = elapsed / within;
            rise_to(fmin(share, 1.0), share < 1.0 ? 1.0 / (within * t) : 0.0, rise);
        }
        for (int i = 0; i < 3; i++) z[i] += rise[i] * step;
        z[0] += preview->standing + level;
        if (!steady) {
            const double rate = preview->rate[k];
            z[2] = z[2] * rate * rate + z[1] * preview->bend[k];
            z[1] *= rate;
        }
        for (int i = 0; i < 3; i++) preview->height[i * count + k - 1] = z[i];
    }
}

/* Counterpart of the end of `planner.references.com_height.preview_height`, and of
 * `planner.model.dcm.natural_frequency`. */
void preview_weigh(const Preview *preview) {
    const int64_t count = preview->samples - 2, last = preview->counted - 1;
    for (int64_t k = 0; k < count; k++) {
        const double over = fmax(preview->height[k] - preview->ground[k], preview->least_height);
        const double pressing = fmax(preview->gravity + preview->height[2 * count + k], preview->least_pressing);
        preview->stiffness[k] = pressing / over;
        preview->softened[k] = preview->softening * preview->stiffness[k];
    }
    double omega = sqrt(preview->softened[last]);
    preview->omega[last] = omega;
    for (int64_t k = last - 1; k >= 0; k--) {
        const double mean = 0.5 * (preview->softened[k + 1] + preview->softened[k]), root = sqrt(mean);
        const double stretched = tanh(root * preview->sample_time) / root;
        omega = (omega + mean * stretched) / (1.0 + omega * stretched);
        preview->omega[k] = omega;
    }
}

/* All but the height and what follows from it, and these too where the law of the height is known here. */
void preview_look(const Preview *preview, int64_t steady, double now, int64_t lifts) {
    look_up_clock(preview, steady, now);
    look_up_phases(preview);
    refer(preview);
    if (!lifts) return;
    lift(preview, steady);
    preview_weigh(preview);
}

/* Coefficients of t^2 to t^5 of `planner.geometry.quintic`. */
static void quintic_bends(const double *start, const double *end, double t, double *c) {
    const double gap = end[0] - start[0] - t * start[1] - 0.5 * t * t * start[2];
    const double speed = t * (end[1] - start[1] - t * start[2]), bend = t * t * (end[2] - start[2]);
    c[0] = 0.5 * start[2];
    c[1] = (10.0 * gap - 4.0 * speed + 0.5 * bend) / (t * t * t);
    c[2] = (-15.0 * gap + 7.0 * speed - bend) / (t * t * t * t);
    c[3] = (6.0 * gap - 3.0 * speed + 0.5 * bend) / (t * t * t * t * t);
}

/* Counterpart of the search in `planner.references.height_transition.HeightTransition.onto`: how many samples. */
int64_t preview_transition(const Preview *preview, int64_t soonest, double bound, double z, double speed, double bend) {
    const int64_t count = preview->samples - 2, last = count - 1;
    const double state[3] = {z, speed, bend};
    int64_t best = last;
    double least = INFINITY;
    for (int64_t samples = soonest < last ? soonest : last; samples <= last; samples++) {
        const double end[3] = {preview->height[samples], preview->height[count + samples],
                               preview->height[2 * count + samples]};
        const double lasting = (double)samples * preview->sample_time;
        double c[4], hardest = 0.0;
        quintic_bends(state, end, lasting, c);
        for (int64_t i = 0; i < preview->looked_at; i++) {
            const double t = lasting * (double)i / (double)(preview->looked_at - 1);
            hardest = fmax(hardest, fabs(2.0 * c[0] + t * (6.0 * c[1] + t * (12.0 * c[2] + t * 20.0 * c[3]))));
        }
        if (hardest < least) {
            least = hardest;
            best = samples;
        }
        if (hardest <= bound) break;
    }
    return best;
}
