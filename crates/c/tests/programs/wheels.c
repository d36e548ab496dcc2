/* Replays ranges and wheels through the tracker of a robot with wheels. */
#include "robot.h"
#include "sleep.h"

static uint64_t memory[KESTIRIM_WHEELS_SIZE / 8];
SLEEP_BYTES(KESTIRIM_WHEELS_SNAPSHOT);

static kestirim_status take(kestirim_wheels *tracker, const struct record *record)
{
    if (record->kind == RANGE) {
        const kestirim_range range = {now_us, record->anchor, record->values[0]};
        return kestirim_wheels_range(tracker, &range, NULL);
    }
    if (record->kind == ODOMETRY) {
        const kestirim_odometry wheels = {now_us, record->values[0], record->values[1]};
        return kestirim_wheels_odometry(tracker, &wheels);
    }
    return KESTIRIM_STATUS_OK;
}

int main(void)
{
    const size_t count = begin();
    kestirim_wheels *tracker;
    port_check(
        kestirim_wheels_init(memory, sizeof memory, &config, anchors, count, &tracker));
    struct record record;
    for (uint32_t taken = 1; port_read(&record, sizeof record); ++taken) {
        now_us += record.elapsed_us;
        tell_status(take(tracker, &record));
        SLEEP_NOW(wheels, tracker);
        float position[2], sigma;
        if (taken % 100 == 0 && kestirim_wheels_position(tracker, &position) == KESTIRIM_STATUS_OK) {
            port_tell("position", position, 2);
            port_check(kestirim_wheels_sigma(tracker, now_us, &sigma));
            port_tell("sigma", &sigma, 1);
        }
    }
    kestirim_health health;
    port_check(kestirim_wheels_health(tracker, now_us, &health, NULL));
    port_tell("health", &health.reasons, 1);
    return 0;
}
