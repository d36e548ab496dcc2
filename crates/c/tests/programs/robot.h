/* The stream of robot.c and wheels.c: a head, the anchors (four floats each), and records. */
#ifndef ROBOT_H
#define ROBOT_H

#include "kestirim.h"
#include "port.h"

struct head {
    uint32_t anchors, calibration;
    float height;
};

enum kind { RANGE = 0, INERTIAL = 1, ODOMETRY = 2 };

struct record {
    uint32_t elapsed_us, kind, anchor;
    float values[3];
};

static uint64_t now_us;
static kestirim_tag_config config;
static kestirim_anchor anchors[KESTIRIM_MOST_ANCHORS];

/* Reads head and anchors; how many there are. */
static size_t begin(void)
{
    struct head head = {0, 0, 0.0f};
    port_check(port_read(&head, sizeof head) ? KESTIRIM_STATUS_OK : KESTIRIM_STATUS_TOO_FEW);
    config.calibration = head.calibration;
    config.height = head.height;
    for (uint32_t i = 0; i < head.anchors && i < KESTIRIM_MOST_ANCHORS; ++i) {
        port_read(&anchors[i], sizeof anchors[i]);
    }
    return head.anchors;
}

/* What a refused sample is told as; the estimate goes on. */
static void tell_status(kestirim_status status)
{
    if (status != KESTIRIM_STATUS_OK) {
        port_tell("status", &status, 1);
    }
}

#endif
