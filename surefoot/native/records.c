/* Rows of the log as they lie in its messages, and what of a body's row follows from the rest of it. */
#include "algebra.h"
#include "kernels.h"

static char *at(int64_t address) { return (char *)(intptr_t)address; }

/* Puts the row into record `number` of each channel, with its time [ns] and its number in the file. */
static void put_row(const LogRows *rows, int64_t number, int64_t time, int64_t sequence) {
    const uint32_t counted = (uint32_t)sequence;
    for (int64_t c = 0; c < rows->channels; c++) {
        char *record = at(rows->records[c]) + number * rows->lengths[c];
        memcpy(record + rows->header[0], &counted, sizeof counted);
        for (int i = 1; i < 4; i++) memcpy(record + rows->header[i], &time, sizeof time);
    }
    for (int64_t f = 0; f < rows->fields; f++) {
        char *place = at(rows->places[f]) + number * rows->strides[f];
        const double *values = rows->values + rows->first[f];
        if (!rows->whole[f]) {
            memcpy(place, values, rows->sizes[f] * sizeof(double));
            continue;
        }
        for (int64_t i = 0; i < rows->sizes[f]; i++) {
            const int32_t value = (int32_t)values[i];
            memcpy(place + i * sizeof value, &value, sizeof value);
        }
    }
}

/* Completes rows and puts them into the messages of their channels; the first has this number in the file. */
void log_rows_put(const LogRows *rows, int64_t count, int64_t sequence) {
    const int64_t m = rows->vectors_width, n = rows->numbers_width;
    for (int64_t k = 0; k < count; k++) {
        memcpy(rows->values, rows->vectors + k * m, m * sizeof(double));
        memcpy(rows->values + m, rows->numbers + k * n, n * sizeof(double));
        calls_run(rows->before);
        put_row(rows, k, rows->times[k], sequence + k);
    }
}

/* Fills a row of a table from the arrays that it is made of. */
void log_row_gather(const RowSources *row, int64_t number) {
    double *values = row->values + number * row->width;
    for (int64_t k = 0; k < row->count; values += row->sizes[k++])
        memcpy(values, (const void *)(intptr_t)row->sources[k], row->sizes[k] * sizeof(double));
}

/* A varint of five bytes behind its tag. */
static void put_varint(char *place, char tag, int64_t value) {
    place[0] = tag;
    for (int k = 0; k < 5; k++) place[1 + k] = (char)((value >> 7 * k & 127) | (k < 4 ? 128 : 0));
}

/* Writes values and stamps into a message. */
void template_fill(const MessageTemplate *message, int64_t seconds, int64_t nanos) {
    char *bytes = at(message->message);
    for (int64_t k = 0; k < message->count; k++)
        memcpy(bytes + message->places[k], message->values + message->picked[k], sizeof(double));
    for (int64_t k = 0; k < message->stamps; k++) {
        char *stamp = bytes + message->stamp_places[k];
        put_varint(stamp, 0x08, seconds);
        put_varint(stamp + 6, 0x10, nanos);
    }
}

/* ZMP and centres of pressure of both soles; counterpart of `scenarios.record.body.contact_points`. */
static void contact_points(const BodyRow *row) {
    double total = 0.0, height = 0.0, x = 0.0, y = 0.0, force[2][3], torque[2][3];
    for (int k = 0; k < 2; k++) {
        const double *wrench = row->wrench + 6 * k, *rotation = row->sole_rotation + 9 * k;
        const double normal = wrench[2] < row->unloaded ? NAN : wrench[2];
        double *cop = k ? row->cop_right : row->cop_left;
        cop[0] = -wrench[4] / normal;
        cop[1] = wrench[3] / normal;
        row->normal_force[k] = wrench[2];
        rotate(rotation, wrench, force[k]);
        rotate(rotation, wrench + 3, torque[k]);
        total += force[k][2];
        height += force[k][2] * row->soles[7 * k + 2];
    }
    if (total < row->unloaded) total = NAN;
    height /= total;
    for (int k = 0; k < 2; k++) {
        const double *sole = row->soles + 7 * k, lever = sole[2] - height;
        x += torque[k][0] + sole[1] * force[k][2] - lever * force[k][1];
        y += torque[k][1] + lever * force[k][0] - sole[0] * force[k][2];
    }
    row->zmp[0] = -y / total;
    row->zmp[1] = x / total;
    row->zmp[2] = height;
}

/* Counterpart of `scenarios.record.body.Recorder._derived`. */
void body_row_derive(const BodyRow *row) {
    double most = 0.0;
    contact_points(row);
    row->solver[0] = row->status[0] == row->second;
    row->fallback[0] = row->status[0] >= row->without;
    row->tilt[0] = acos(row->upright[0] < 1.0 ? row->upright[0] : 1.0);
    for (int i = 0; i < 2; i++) row->dcm[i] = row->com[i] + row->com_velocity[i] / row->omega[0];
    for (int64_t j = 0; j < row->joints; j++) {
        const double ratio = fabs(row->command[j] * row->inverse_limit[j]);
        if (!(ratio <= most)) most = ratio;
        if (most != most) break;
    }
    row->limit_ratio[0] = most;
}

void estimation_row_derive(const EstimationRow *row) {
    static const double pi = 3.14159265358979323846;
    const double *R = row->base_rotation, *true_R = row->true_base_rotation;
    const double *sole = row->soles + (row->stance[0] > 0.0 ? 7 : 0);
    const double *true_sole = row->true_soles + (sole - row->soles);
    const double off = fmod(atan2(R[1], R[0]) - atan2(true_R[1], true_R[0]) + pi, 2.0 * pi);
    const double yaw = (off < 0.0 ? off + 2.0 * pi : off) - pi, c = cos(-yaw), s = sin(-yaw);
    const double back[9] = {c, -s, 0.0, s, c, 0.0, 0.0, 0.0, 1.0};
    double turned[9], seen[9], tilt[9], from_foot[3];
    for (int i = 0; i < 3; i++) from_foot[i] = row->com[i] - sole[i];
    rotate(back, from_foot, row->com_error);
    rotate(back, row->com_velocity, row->com_velocity_error);
    for (int i = 0; i < 3; i++) {
        row->com_error[i] -= row->true_com[i] - true_sole[i];
        row->com_velocity_error[i] -= row->true_com_velocity[i];
        row->place_error[i] = sole[i] - true_sole[i];
    }
    transpose(R, turned);
    fused_compose(back, turned, seen);
    fused_compose(seen, true_R, tilt); /* in memory, what lies by columns is its transpose by rows */
    row->tilt_error[0] = 0.5 * (tilt[7] - tilt[5]);
    row->tilt_error[1] = 0.5 * (tilt[2] - tilt[6]);
    row->yaw_error[0] = yaw;
    for (int k = 0; k < 2; k++) row->sole_height_error[k] = row->soles[7 * k + 2] - row->true_soles[7 * k + 2];
}
