/* An IMU on a foot stands for two seconds at 100 Hz. */
#include "esp_log.h"
#include "kestirim.h"

static uint64_t memory[KESTIRIM_PEDESTRIAN_SIZE / 8];

void app_main(void)
{
    const kestirim_pedestrian_config config = {KESTIRIM_SENSOR_CONSUMER, 0.07f};
    kestirim_pedestrian *tracker;
    kestirim_status status = kestirim_pedestrian_init(memory, sizeof memory, &config, &tracker);
    for (uint64_t k = 0; k < 200 && status == KESTIRIM_STATUS_OK; ++k) {
        const kestirim_pedestrian_sample sample = {10000 * k, {0.0f, 1.7f, 9.66f}, {0.01f, 0.0f, -0.02f}};
        status = kestirim_pedestrian_update(tracker, &sample);
    }
    float position[3] = {0};
    if (status == KESTIRIM_STATUS_OK) {
        status = kestirim_pedestrian_position(tracker, &position);
    }
    ESP_LOGI("kestirim", "%s: %f %f %f m", kestirim_status_name(status), position[0], position[1], position[2]);
}
