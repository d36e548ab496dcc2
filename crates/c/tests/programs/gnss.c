/* Replays epochs of a GNSS receiver: a head, and so many observations. The antennas are those of the stream's maker. */
#include "kestirim.h"
#include "port.h"
#include "sleep.h"

struct head {
    int32_t day;
    uint32_t count;
    double second;
};

struct observed {
    double satellite, code[2], phase[2];
    kestirim_gnss_satellite state;
};

static const double satellite_mean[3] = {-0.0008, -0.0045, 0.0026};
static const double receiver_mean[4] = {0.0, -0.0041, -0.0018, 0.0094};
static const double receiver_rows[12] = {0.0, -0.0040, -0.0016, 0.0090, 0.0, -0.0042,
                                         -0.0020, 0.0098, 0.0, -0.0040, -0.0016, 0.0090};
static const kestirim_gnss_pattern satellite[2] = {
    {{0.279, 0.0, 2.3195}, 0.0, 7.0, satellite_mean, 3, 0.0, NULL, 0},
    {{0.279, 0.0, 2.2895}, 0.0, 7.0, satellite_mean, 3, 0.0, NULL, 0},
};
static const kestirim_gnss_pattern receiver[2] = {
    {{0.0012, -0.0004, 0.0892}, 0.0, 30.0, receiver_mean, 4, 180.0, receiver_rows, 12},
    {{0.0, 0.0001, 0.1185}, 0.0, 30.0, receiver_mean, 4, 180.0, receiver_rows, 12},
};

static uint64_t memory[KESTIRIM_GNSS_SIZE / 8];
SLEEP_BYTES(KESTIRIM_GNSS_SNAPSHOT);
static kestirim_gnss_observation observations[KESTIRIM_MOST_SATELLITES];

int main(void)
{
    const kestirim_gnss_config config = {0.0, 0.13962634015954636, -18.24, {0.0, 0.0, 0.0083}, 0};
    kestirim_gnss *filter;
    struct head head;
    port_check(kestirim_gnss_init(memory, sizeof memory, &config, &filter));
    while (port_read(&head, sizeof head)) {
        for (uint32_t i = 0; i < head.count && i < KESTIRIM_MOST_SATELLITES; ++i) {
            struct observed observed;
            kestirim_gnss_observation *observation = &observations[i];
            port_read(&observed, sizeof observed);
            observation->satellite = (uint8_t)observed.satellite;
            observation->carriers = KESTIRIM_GNSS_CARRIERS_L1L2;
            for (int carrier = 0; carrier < 2; ++carrier) {
                observation->code[carrier] = observed.code[carrier];
                observation->phase[carrier] = observed.phase[carrier];
            }
            observation->state = observed.state;
            observation->antenna = &satellite;
        }
        const kestirim_gnss_time time = {head.day, head.second};
        kestirim_gnss_solution solution;
        port_check(kestirim_gnss_update(filter, &time, &receiver, observations, head.count, &solution));
        SLEEP_NOW(gnss, filter);
        port_tell("position", solution.position, 6);
        port_tell("sigma", solution.sigma, 6);
        port_tell("clock", &solution.clock, 4);
        port_tell("health", &solution.health.reasons, 1);
    }
    return 0;
}
