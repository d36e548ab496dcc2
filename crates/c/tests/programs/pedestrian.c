/* Replays the samples of a foot's IMU: a record is the time since the one before (µs) and six floats. */
#include "kestirim.h"
#include "port.h"
#include "sleep.h"

struct record {
    uint32_t elapsed_us;
    float specific_force[3], angular_rate[3];
};

static uint64_t memory[KESTIRIM_PEDESTRIAN_SIZE / 8];
SLEEP_BYTES(KESTIRIM_PEDESTRIAN_SNAPSHOT);

static void tell(const kestirim_pedestrian *tracker)
{
    float position[3], sigma[3];
    port_check(kestirim_pedestrian_position(tracker, &position));
    port_tell("position", position, 3);
    port_check(kestirim_pedestrian_sigma(tracker, &sigma));
    port_tell("sigma", sigma, 3);
}

int main(void)
{
    const kestirim_pedestrian_config config = {KESTIRIM_SENSOR_CONSUMER, 0.07f};
    kestirim_pedestrian *tracker;
    kestirim_pedestrian_sample sample = {0};
    struct record record;
    port_check(kestirim_pedestrian_init(memory, sizeof memory, &config, &tracker));
    for (uint32_t count = 1; port_read(&record, sizeof record); ++count) {
        sample.time_us += record.elapsed_us;
        for (int axis = 0; axis < 3; ++axis) {
            sample.specific_force[axis] = record.specific_force[axis];
            sample.angular_rate[axis] = record.angular_rate[axis];
        }
        port_check(kestirim_pedestrian_update(tracker, &sample));
        SLEEP_NOW(pedestrian, tracker);
        if (count % 50 == 0) {
            tell(tracker);
        }
    }
    kestirim_pedestrian_finish(tracker, NULL);
    tell(tracker);
    float length;
    kestirim_health health;
    port_check(kestirim_pedestrian_path_length(tracker, &length));
    port_tell("length", &length, 1);
    port_check(kestirim_pedestrian_health(tracker, &health));
    port_tell("health", &health.reasons, 1);
    return 0;
}
