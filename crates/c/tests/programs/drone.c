/* Replays the levels that a drone received: how many corners the area has, the corners, and a record a measurement. */
#include "kestirim.h"
#include "port.h"
#include "sleep.h"

static uint64_t memory[KESTIRIM_DRONE_SIZE / 8];
SLEEP_BYTES(KESTIRIM_DRONE_SNAPSHOT);
static float corners[KESTIRIM_MOST_CORNERS][2];

int main(void)
{
    kestirim_drone *search;
    kestirim_drone_measurement measurement;
    uint32_t count = 0;
    port_check(port_read(&count, sizeof count) ? KESTIRIM_STATUS_OK : KESTIRIM_STATUS_TOO_FEW);
    for (uint32_t i = 0; i < count && i < KESTIRIM_MOST_CORNERS; ++i) {
        port_read(corners[i], sizeof corners[i]);
    }
    port_check(kestirim_drone_init(memory, sizeof memory, (const float(*)[2])corners, count, &search));
    while (port_read(&measurement, sizeof measurement)) {
        port_check(kestirim_drone_update(search, &measurement));
        SLEEP_NOW(drone, search);
    }
    kestirim_drone_place place;
    port_check(kestirim_drone_estimate(search, &place));
    port_tell("place", &place, 4);
    port_tell("health", &place.health.reasons, 1);
    return 0;
}
