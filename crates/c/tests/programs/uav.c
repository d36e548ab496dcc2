/* Replays a flight of an Aerosonde through its filter: a record is inputs, outputs, and which of them there are. */
#include "kestirim.h"
#include "port.h"
#include "sleep.h"

struct record {
    uint32_t elapsed_us, present;
    float input[2], measured[3];
};

static uint64_t memory[KESTIRIM_UAV_SIZE / 8];
SLEEP_BYTES(KESTIRIM_UAV_SNAPSHOT);
static kestirim_uav_model model;

int main(void)
{
    kestirim_uav *filter;
    kestirim_uav_sample sample = {0};
    struct record record;
    port_check(kestirim_uav_aerosonde(&model));
    port_check(kestirim_uav_init(memory, sizeof memory, &model, &filter));
    for (uint32_t count = 1; port_read(&record, sizeof record); ++count) {
        sample.time_us += record.elapsed_us;
        sample.present = record.present;
        for (int i = 0; i < 2; ++i) {
            sample.input[i] = (double)record.input[i];
        }
        for (int i = 0; i < 3; ++i) {
            sample.measured[i] = (double)record.measured[i];
        }
        port_check(kestirim_uav_update(filter, &sample));
        SLEEP_NOW(uav, filter);
        double numbers[4];
        if (count % 20 == 0) {
            port_check(kestirim_uav_estimate(filter, &numbers));
            port_tell("estimate", numbers, 8);
            port_check(kestirim_uav_sigma(filter, &numbers));
            port_tell("sigma", numbers, 8);
        }
    }
    kestirim_health health;
    port_check(kestirim_uav_health(filter, &health));
    port_tell("health", &health.reasons, 1);
    return 0;
}
