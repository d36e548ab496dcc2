/* Replays ranges, an IMU and wheels through the tracker of a tag in the plane. */
#include "robot.h"
#include "sleep.h"

static uint64_t memory[KESTIRIM_ROBOT_SIZE / 8];
SLEEP_BYTES(KESTIRIM_ROBOT_SNAPSHOT);

static kestirim_status take(kestirim_robot *tracker, const struct record *record)
{
    if (record->kind == RANGE) {
        const kestirim_range range = {now_us, record->anchor, record->values[0]};
        return kestirim_robot_range(tracker, &range, NULL);
    }
    if (record->kind == ODOMETRY) {
        const kestirim_odometry wheels = {now_us, record->values[0], record->values[1]};
        return kestirim_robot_odometry(tracker, &wheels);
    }
    const float *a = record->values;
    const kestirim_inertial inertial = {now_us, {a[0], a[1], a[2]}};
    return kestirim_robot_inertial(tracker, &inertial);
}

int main(void)
{
    const size_t count = begin();
    kestirim_robot *tracker;
    port_check(
        kestirim_robot_init(memory, sizeof memory, &config, anchors, count, &tracker));
    struct record record;
    for (uint32_t taken = 1; port_read(&record, sizeof record); ++taken) {
        now_us += record.elapsed_us;
        tell_status(take(tracker, &record));
        SLEEP_NOW(robot, tracker);
        float position[2], velocity[2], sigma;
        if (taken % 100 == 0 && kestirim_robot_position(tracker, &position) == KESTIRIM_STATUS_OK) {
            port_tell("position", position, 2);
            port_check(kestirim_robot_velocity(tracker, &velocity));
            port_tell("velocity", velocity, 2);
            port_check(kestirim_robot_sigma(tracker, now_us, &sigma));
            port_tell("sigma", &sigma, 1);
        }
    }
    kestirim_health health;
    port_check(kestirim_robot_health(tracker, now_us, &health, NULL));
    port_tell("health", &health.reasons, 1);
    return 0;
}
