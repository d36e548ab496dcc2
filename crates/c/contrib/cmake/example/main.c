/* An IMU on a foot stands for two seconds at 100 Hz. */
#include <stdio.h>

#include "kestirim.h"

static uint64_t memory[KESTIRIM_PEDESTRIAN_SIZE / 8];

int main(void)
{
    const kestirim_pedestrian_config config = {KESTIRIM_SENSOR_CONSUMER, 0.07f};
    kestirim_pedestrian *tracker;
    kestirim_status status = kestirim_pedestrian_init(memory, sizeof memory, &config, &tracker);
    for (uint64_t k = 0; k < 200 && status == KESTIRIM_STATUS_OK; ++k) {
        const kestirim_pedestrian_sample sample = {10000 * k, {0.0f, 1.7f, 9.66f}, {0.01f, 0.0f, -0.02f}};
        status = kestirim_pedestrian_update(tracker, &sample);
    }
    float position[3], sigma[3];
    kestirim_health health;
    if (status == KESTIRIM_STATUS_OK) {
        status = kestirim_pedestrian_position(tracker, &position);
    }
    if (status != KESTIRIM_STATUS_OK) {
        fprintf(stderr, "%s\n", kestirim_status_name(status));
        return 1;
    }
    kestirim_pedestrian_sigma(tracker, &sigma);
    kestirim_pedestrian_health(tracker, &health);
    printf("%.3f %.3f %.3f m, +- %.3f %.3f %.3f m, %s\n", (double)position[0], (double)position[1],
           (double)position[2], (double)sigma[0], (double)sigma[1], (double)sigma[2],
           health.state == KESTIRIM_STATE_GOOD ? "good" : "not good");
    return 0;
}
