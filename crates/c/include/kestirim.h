// Kestirim: estimators for localisation, for C and C++.
//
// Objects stand in memory of the caller's: of at least kestirim_SYSTEM_size() bytes (KESTIRIM_SYSTEM_SIZE at most, for
// static memory), aligned as a double or an int64_t is. kestirim_SYSTEM_init() answers with a handle into it; nothing is
// allocated, nothing is global, and nothing need be freed. Do not copy or move the memory, and do not write into it.
//
// Pointers are checked: null, wrongly aligned, too little memory, and memory that holds no such object are told by a
// kestirim_status. What nobody can check the caller keeps: memory is his own and as large as he says; arrays hold as many
// as he says; and no two calls use one object at the same time (in an interrupt, in another thread). Calls with different
// objects may. A call that fails has changed nothing and written no answer.
//
// Units are SI: m, s, rad, unless a field says otherwise. Time is integer microseconds of one clock. Frames are named
// where they matter. Numbers are `float` whatever the library computes with (`float`, or fixed point if it was built with
// the feature `fixed`, for processors without a floating-point unit); GNSS and aircraft models take `double`.


#ifndef KESTIRIM_H
#define KESTIRIM_H

// Made by cbindgen of crates/c: do not edit. `crates/c/tests/c/header.rs` compares it.

#include <stddef.h>
#include <stdint.h>

// Most corners of an area.
#define KESTIRIM_MOST_CORNERS 16

// Bytes that a search takes at most, on any target.
#define KESTIRIM_DRONE_SIZE 1024

// Bytes that a snapshot takes at most, on any target.
#define KESTIRIM_DRONE_SNAPSHOT (((KESTIRIM_DRONE_SIZE / 4) * 5) + 64)

// Most satellites of an epoch.
#define KESTIRIM_MOST_SATELLITES 12

// Bytes that a filter takes at most, on any target.
#define KESTIRIM_GNSS_SIZE 10240

// Bytes that a snapshot takes at most, on any target.
#define KESTIRIM_GNSS_SNAPSHOT (((KESTIRIM_GNSS_SIZE / 4) * 5) + 64)

// Most samples of an orbit or a clock: four hours of an orbit every quarter of an hour.
#define KESTIRIM_MOST_PRODUCTS 16

// Bytes that a pedestrian's tracker takes at most, on any target: for memory that is set aside by the compiler.
#define KESTIRIM_PEDESTRIAN_SIZE 2048

// Bytes that a snapshot takes at most, on any target.
#define KESTIRIM_PEDESTRIAN_SNAPSHOT (((KESTIRIM_PEDESTRIAN_SIZE / 4) * 5) + 64)

// Most anchors of a tracker.
#define KESTIRIM_MOST_ANCHORS 8

// Bytes that a tracker takes at most, on any target.
#define KESTIRIM_ROBOT_SIZE 1536

// Bytes that a snapshot takes at most, on any target.
#define KESTIRIM_ROBOT_SNAPSHOT (((KESTIRIM_ROBOT_SIZE / 4) * 5) + 64)

// Outputs of a filter.
#define KESTIRIM_UAV_OUTPUTS 3

// Bytes that a filter takes at most, on any target.
#define KESTIRIM_UAV_SIZE 2048

// Bytes that a snapshot takes at most, on any target.
#define KESTIRIM_UAV_SNAPSHOT (((KESTIRIM_UAV_SIZE / 4) * 5) + 64)

// Bytes that a tracker takes at most, on any target.
#define KESTIRIM_WHEELS_SIZE 2048

// Bytes that a snapshot takes at most, on any target.
#define KESTIRIM_WHEELS_SNAPSHOT (((KESTIRIM_WHEELS_SIZE / 4) * 5) + 64)

// Outcome of a call. If it is not `KESTIRIM_STATUS_OK`, nothing was changed, and no answer was written.
enum kestirim_status
#if defined(__cplusplus) || __STDC_VERSION__ >= 202311L
  : int32_t
#endif // defined(__cplusplus) || __STDC_VERSION__ >= 202311L
 {
  // Done.
  KESTIRIM_STATUS_OK = 0,
  // A pointer is null.
  KESTIRIM_STATUS_NULL_POINTER = 1,
  // A pointer is not aligned as its type wants it.
  KESTIRIM_STATUS_MISALIGNED = 2,
  // The memory is smaller than the object.
  KESTIRIM_STATUS_TOO_SMALL = 3,
  // The memory holds no object of this type: it was not initialised, or overwritten.
  KESTIRIM_STATUS_NOT_INITIALISED = 4,
  // A choice is none of those that there are, or a setting is out of its range.
  KESTIRIM_STATUS_INVALID_ARGUMENT = 5,
  // There is no estimate: none yet, or it was lost.
  KESTIRIM_STATUS_NO_ESTIMATE = 6,
  // A number is NaN, infinite, or beyond what fixed point holds.
  KESTIRIM_STATUS_NOT_FINITE = 7,
  // No sensor can have measured this.
  KESTIRIM_STATUS_IMPLAUSIBLE = 8,
  // The time is before that of the last sample.
  KESTIRIM_STATUS_OUT_OF_ORDER = 9,
  // The same measurement came before.
  KESTIRIM_STATUS_DUPLICATE = 10,
  // No anchor has this number.
  KESTIRIM_STATUS_NO_SUCH_ANCHOR = 11,
  // More anchors, corners, satellites or samples than there is room for.
  KESTIRIM_STATUS_TOO_MANY = 12,
  // Fewer than are needed: anchors, satellites, corners.
  KESTIRIM_STATUS_TOO_FEW = 13,
  // The measurements contradict each other, or nothing explains them.
  KESTIRIM_STATUS_CONTRADICTORY = 14,
  // The time since the last sample is too long for the estimate to be carried over it, or no multiple of the model's
  // interval.
  KESTIRIM_STATUS_GAP = 15,
  // The geometry determines no position, the corners enclose nothing, or a matrix has no inverse.
  KESTIRIM_STATUS_GEOMETRY = 16,
  // The estimator refused the step for another reason.
  KESTIRIM_STATUS_REFUSED = 17,
  // The bytes are no snapshot of an object.
  KESTIRIM_STATUS_NO_SNAPSHOT = 18,
  // A snapshot of another object, of another version of this library, or of other numbers (`float` or fixed point).
  KESTIRIM_STATUS_FOREIGN_SNAPSHOT = 19,
  // A snapshot that was not written whole, or was changed.
  KESTIRIM_STATUS_DAMAGED_SNAPSHOT = 20,
};
#ifndef __cplusplus
#if __STDC_VERSION__ >= 202311L
typedef enum kestirim_status kestirim_status;
#else
typedef int32_t kestirim_status;
#endif // __STDC_VERSION__ >= 202311L
#endif // __cplusplus

// How far an estimate can be relied upon.
enum kestirim_state
#if defined(__cplusplus) || __STDC_VERSION__ >= 202311L
  : uint32_t
#endif // defined(__cplusplus) || __STDC_VERSION__ >= 202311L
 {
  // As its standard deviation says.
  KESTIRIM_STATE_GOOD = 0,
  // Worse than with better data; what is said of its accuracy still holds, more or less.
  KESTIRIM_STATE_DEGRADED = 1,
  // It may be wrong by far more than anything says: not to be relied upon.
  KESTIRIM_STATE_BAD = 2,
};
#ifndef __cplusplus
#if __STDC_VERSION__ >= 202311L
typedef enum kestirim_state kestirim_state;
#else
typedef uint32_t kestirim_state;
#endif // __STDC_VERSION__ >= 202311L
#endif // __cplusplus

// Outcome of a range.
enum kestirim_range_outcome
#if defined(__cplusplus) || __STDC_VERSION__ >= 202311L
  : uint32_t
#endif // defined(__cplusplus) || __STDC_VERSION__ >= 202311L
 {
  // Kept for a first position, for which more are needed.
  KESTIRIM_RANGE_OUTCOME_COLLECTED = 0,
  // It made a first position possible, or a new one after the tracker was lost.
  KESTIRIM_RANGE_OUTCOME_STARTED = 1,
  // Taken in with its full weight.
  KESTIRIM_RANGE_OUTCOME_TAKEN = 2,
  // Taken in with less weight: it is longer or shorter than expected.
  KESTIRIM_RANGE_OUTCOME_WEAKENED = 3,
  // Left out.
  KESTIRIM_RANGE_OUTCOME_REJECTED = 4,
  // Taken in although it does not fit: too many had been left out.
  KESTIRIM_RANGE_OUTCOME_RECOVERED = 5,
};
#ifndef __cplusplus
#if __STDC_VERSION__ >= 202311L
typedef enum kestirim_range_outcome kestirim_range_outcome;
#else
typedef uint32_t kestirim_range_outcome;
#endif // __STDC_VERSION__ >= 202311L
#endif // __cplusplus

// State of a tag's position.
enum kestirim_tag_state
#if defined(__cplusplus) || __STDC_VERSION__ >= 202311L
  : uint32_t
#endif // defined(__cplusplus) || __STDC_VERSION__ >= 202311L
 {
  // No position has been found yet.
  KESTIRIM_TAG_STATE_INITIALISING = 0,
  // Ranges come in and fit.
  KESTIRIM_TAG_STATE_TRACKING = 1,
  // No range came for a second or two rounds of the anchors: the position is extrapolated.
  KESTIRIM_TAG_STATE_COASTING = 2,
  // The position has become worthless: the next ranges make a new one.
  KESTIRIM_TAG_STATE_LOST = 3,
};
#ifndef __cplusplus
#if __STDC_VERSION__ >= 202311L
typedef enum kestirim_tag_state kestirim_tag_state;
#else
typedef uint32_t kestirim_tag_state;
#endif // __STDC_VERSION__ >= 202311L
#endif // __cplusplus

// Class of an IMU.
enum kestirim_sensor
#if defined(__cplusplus) || __STDC_VERSION__ >= 202311L
  : uint32_t
#endif // defined(__cplusplus) || __STDC_VERSION__ >= 202311L
 {
  // A calibrated unit (`MicroStrain`, Xsens, NGIMU): its gyroscope starts within 3 mrad/s of zero.
  KESTIRIM_SENSOR_INDUSTRIAL = 0,
  // A bare chip (MPU-6050, MPU-9250, BNO055, LSM6DS): its gyroscope may start 0.1 rad/s off.
  KESTIRIM_SENSOR_CONSUMER = 1,
};
#ifndef __cplusplus
#if __STDC_VERSION__ >= 202311L
typedef enum kestirim_sensor kestirim_sensor;
#else
typedef uint32_t kestirim_sensor;
#endif // __STDC_VERSION__ >= 202311L
#endif // __cplusplus

// Bits of `kestirim_health.reasons`: why an estimate is not good.
enum kestirim_reason
#if defined(__cplusplus) || __STDC_VERSION__ >= 202311L
  : uint32_t
#endif // defined(__cplusplus) || __STDC_VERSION__ >= 202311L
 {
  // A sensor was at its end.
  KESTIRIM_REASON_SATURATED = 1,
  // A sensor repeated itself.
  KESTIRIM_REASON_STUCK = (1 << 1),
  // Data are missing, or too few.
  KESTIRIM_REASON_DROPOUT = (1 << 2),
  // More measurements than usual contradict the estimate and were left out.
  KESTIRIM_REASON_REJECTED = (1 << 3),
  // What the estimate needs cannot be seen in the data.
  KESTIRIM_REASON_NOT_OBSERVABLE = (1 << 4),
  // Times run too fast or too slow, or products belong to another time.
  KESTIRIM_REASON_TIME = (1 << 5),
  // Data seem to be in another unit, or of another sign.
  KESTIRIM_REASON_UNITS = (1 << 6),
  // Axes seem to be swapped or mirrored.
  KESTIRIM_REASON_AXES = (1 << 7),
  // Measurements and geometry contradict each other.
  KESTIRIM_REASON_GEOMETRY = (1 << 8),
  // One anchor, or two that seem swapped, contradict the others.
  KESTIRIM_REASON_ANCHOR = (1 << 9),
  // The height that was said contradicts the measurements.
  KESTIRIM_REASON_HEIGHT = (1 << 10),
  // What is left of the measurements is beyond its bound.
  KESTIRIM_REASON_INNOVATIONS = (1 << 11),
  // The estimate left the range of its numbers.
  KESTIRIM_REASON_RANGE = (1 << 12),
};
#ifndef __cplusplus
#if __STDC_VERSION__ >= 202311L
typedef enum kestirim_reason kestirim_reason;
#else
typedef uint32_t kestirim_reason;
#endif // __STDC_VERSION__ >= 202311L
#endif // __cplusplus

// How well the anchors are known.
enum kestirim_calibration
#if defined(__cplusplus) || __STDC_VERSION__ >= 202311L
  : uint32_t
#endif // defined(__cplusplus) || __STDC_VERSION__ >= 202311L
 {
  // As they come: ranges are too long by a decimetre or two.
  KESTIRIM_CALIBRATION_UNCALIBRATED = 0,
  // Each anchor's bias is known, to 5 cm.
  KESTIRIM_CALIBRATION_CALIBRATED = 1,
};
#ifndef __cplusplus
#if __STDC_VERSION__ >= 202311L
typedef enum kestirim_calibration kestirim_calibration;
#else
typedef uint32_t kestirim_calibration;
#endif // __STDC_VERSION__ >= 202311L
#endif // __cplusplus

// Carriers on which a satellite is observed.
enum kestirim_gnss_carriers
#if defined(__cplusplus) || __STDC_VERSION__ >= 202311L
  : uint32_t
#endif // defined(__cplusplus) || __STDC_VERSION__ >= 202311L
 {
  // L1 and L2 of GPS.
  KESTIRIM_GNSS_CARRIERS_L1L2 = 0,
  // E1 and E5a of Galileo.
  KESTIRIM_GNSS_CARRIERS_E1E5A = 1,
  // E1 and E5b of Galileo.
  KESTIRIM_GNSS_CARRIERS_E1E5B = 2,
  // G1 and G2 of GLONASS, on the satellite's channel.
  KESTIRIM_GNSS_CARRIERS_G1G2 = 3,
  // B1I and B3I of BeiDou.
  KESTIRIM_GNSS_CARRIERS_B1B3 = 4,
  // B1I and B2I of BeiDou.
  KESTIRIM_GNSS_CARRIERS_B1B2 = 5,
  // B1C and B2a of BeiDou.
  KESTIRIM_GNSS_CARRIERS_B1C_B2A = 6,
};
#ifndef __cplusplus
#if __STDC_VERSION__ >= 202311L
typedef enum kestirim_gnss_carriers kestirim_gnss_carriers;
#else
typedef uint32_t kestirim_gnss_carriers;
#endif // __STDC_VERSION__ >= 202311L
#endif // __cplusplus

// A search for a transmitter of unknown power over open ground, from the levels that a drone receives.
//
// Places are metres in a plane (such as east and north) of one origin for drone and transmitter.
typedef struct kestirim_drone kestirim_drone;

// A filter of precise point positioning: where a receiver is, to a centimetre, from its dual-frequency observations and
// from orbits and clocks of a service. Double precision: for processors with memory.
//
// Frame: Earth-centred and Earth-fixed (ECEF, that of the orbits), m; deviations to the east, north and up. Time is GPS
// time.
typedef struct kestirim_gnss kestirim_gnss;

// The pedestrian's tracker: where an IMU on a foot is, from what it measures.
//
// Frames: `body` is the IMU's axes, right-handed. `earth` has z up; its origin is where the foot stood first, its
// heading the one it had then.
typedef struct kestirim_pedestrian kestirim_pedestrian;

// A tag in the plane at a known height: position and velocity from single ranges to anchors, in any order, with IMU and
// wheels if there are any.
//
// Frame: the room's axes in which the anchors are given, right-handed with z up, m.
typedef struct kestirim_robot kestirim_robot;

// A Kalman filter along a flight: samples of any times, with gaps between them and outputs that are missing.
//
// States: angle of attack (rad), pitch rate (rad/s), airspeed (m/s), pitch angle (rad). Inputs: elevator (rad), throttle
// (0 to 1). All are deviations from the steady flight at which the model was linearised: subtract it from what is
// measured and applied, and add it to the estimate. Axes are the body's, in a vertical plane.
typedef struct kestirim_uav kestirim_uav;

// A tag in the plane on a robot whose wheels are counted: the wheels move the estimate, the ranges correct it. Scale and
// drift of the wheels' turns are estimated, and so is the heading, of which nothing need be known.
//
// Frame: the room's axes in which the anchors are given, right-handed with z up, m.
typedef struct kestirim_wheels kestirim_wheels;

// A level that the drone received.
typedef struct kestirim_drone_measurement {
  // Where the drone is, m: x, y.
  float place[2];
  // Its height above the transmitter, m.
  float height;
  // The level, dBm or dB of any reference, the same for all measurements.
  float level;
} kestirim_drone_measurement;

// Where the transmitter is.
typedef struct kestirim_drone_place {
  // Its place, m: x, y.
  float place[2];
  // Standard deviation of the place: root of the sum of both axes' variances, m.
  float sigma;
  // The level that is received a metre from it, in the measurements' unit.
  float level;
} kestirim_drone_place;

// Whether an estimate can be relied upon, and all reasons why not.
typedef struct kestirim_health {
  // How far: the state of the worst reason.
  kestirim_state state;
  // A bit a reason: see `kestirim_health_reason`.
  uint32_t reasons;
} kestirim_health;

// Settings of the filter.
typedef struct kestirim_gnss_config {
  // 0: the receiver is at rest. Above: it moves, and this is the variance that a second adds to each coordinate, m²/s
  // (1e4 for anything).
  double process_noise;
  // Lowest elevation of a satellite, rad; 0.14 is 8 degrees.
  double elevation_mask;
  // UT1 (or UTC) minus GPS time, s: the leap seconds since 1980, negated; -18 since 2017.
  double ut1_minus_gps;
  // From the marker to the antenna's reference point, m: east, north, up.
  double eccentricity[3];
} kestirim_gnss_config;

// An instant in GPS time.
typedef struct kestirim_gnss_time {
  // The day, as a modified Julian date.
  int32_t day;
  // The second of the day.
  double second;
} kestirim_gnss_time;

// The phase centre of an antenna on one frequency, as an ANTEX file describes it.
typedef struct kestirim_gnss_pattern {
  // Mean phase centre from the antenna's reference point, m: north, east, up of a receiver's; X, Y, Z of a satellite's.
  double offset[3];
  // First zenith or nadir angle of the grid, degrees.
  double first;
  // Step of the grid, degrees.
  double step;
  // Phase centre variation at each angle, whatever the azimuth, m: `count` numbers.
  const double *mean;
  // How many angles the grid has.
  size_t count;
  // Step of the azimuths, degrees; 0 without them.
  double azimuth_step;
  // A row like `mean` for each azimuth from 0 to 360 degrees, one after the other, m.
  const double *by_azimuth;
  // How many numbers all these rows have; 0 without them.
  size_t azimuth_count;
} kestirim_gnss_pattern;

// A satellite at the time of transmission.
typedef struct kestirim_gnss_satellite {
  // Centre of mass, ECEF at that time, m.
  double position[3];
  // Velocity, m/s.
  double velocity[3];
  // Satellite clock minus GPS time, s, without the effect of its eccentric orbit.
  double clock;
  // Time from the clock's sample before to that after, s; 0: not interpolated.
  double clock_interval;
  // Time to the nearer of both, s.
  double clock_distance;
} kestirim_gnss_satellite;

// Observation of one satellite.
typedef struct kestirim_gnss_observation {
  // Number of the satellite, which no other has: a GPS satellite's PRN, a Galileo satellite's number and 100, say.
  uint8_t satellite;
  // 1 if the receiver reports a loss of lock since the last epoch, else 0.
  uint8_t lock_lost;
  // The channel of a satellite of GLONASS, -7 to 6; 0 of others.
  int8_t channel;
  // Its two carriers: a `kestirim_gnss_carriers`.
  uint32_t carriers;
  // Codes on both, m.
  double code[2];
  // Carrier phases on both, cycles.
  double phase[2];
  // The satellite.
  struct kestirim_gnss_satellite state;
  // Its antenna on both carriers: two patterns, or null if they are not known.
  const struct kestirim_gnss_pattern (*antenna)[2];
} kestirim_gnss_observation;

// Solution of one epoch.
typedef struct kestirim_gnss_solution {
  // The marker, ECEF, m, free of tides.
  double position[3];
  // Standard deviations to the east, north and up, m.
  double sigma[3];
  // Receiver clock minus GPS time, m.
  double clock;
  // Wet zenith delay, m.
  double wet_delay;
  // Whether it can be relied upon.
  struct kestirim_health health;
  // 1 if the ambiguities are known, so that the position is better than 10 cm, else 0.
  uint8_t converged;
  // Satellites above the elevation mask.
  uint8_t satellites;
  // Observations (codes and phases) that had less than their full weight.
  uint8_t treated;
} kestirim_gnss_solution;

// One sample of a satellite's precise orbit (SP3).
typedef struct kestirim_gnss_orbit_sample {
  // Its time.
  struct kestirim_gnss_time time;
  // Centre of mass, ECEF at that time, m.
  double position[3];
} kestirim_gnss_orbit_sample;

// One sample of a satellite's precise clock (CLK, SP3).
typedef struct kestirim_gnss_clock_sample {
  // Its time.
  struct kestirim_gnss_time time;
  // Satellite clock minus GPS time, s.
  double bias;
} kestirim_gnss_clock_sample;

// Settings of sensor and foot.
typedef struct kestirim_pedestrian_config {
  // Class of the IMU: a `kestirim_sensor`.
  uint32_t sensor;
  // Height of the sensor above the ball of the foot, about which the foot rolls, m. 0 takes it for motionless.
  float contact_height;
} kestirim_pedestrian_config;

// One sample of the foot's IMU.
typedef struct kestirim_pedestrian_sample {
  // Time of the sample, µs since any moment.
  uint64_t time_us;
  // Specific force, as an accelerometer measures it, m/s², body: +9.8 upwards at rest.
  float specific_force[3];
  // Angular rate, as a gyroscope measures it, rad/s, body.
  float angular_rate[3];
} kestirim_pedestrian_sample;

// A stride: from one stance of the foot to the next.
typedef struct kestirim_pedestrian_stride {
  // End of the stance it arrived at, µs, the samples' clock.
  uint64_t time_us;
  // Where that is, m, earth.
  float position[3];
  // Horizontal distance from the stance before, m.
  float length;
  // Time since the end of the stance before, s.
  float duration;
  // Turn of its direction from that of the stride before, rad, anticlockwise from above; 0 of the first.
  float heading_change;
} kestirim_pedestrian_stride;

// Estimate after a sample.
typedef struct kestirim_pedestrian_state {
  // Time of the sample, µs.
  uint64_t time_us;
  // Position of the sensor, m, earth.
  float position[3];
  // Velocity of the sensor, m/s, earth.
  float velocity[3];
  // Orientation of the sensor, body to earth: quaternion w, x, y, z.
  float orientation[4];
  // 1 if the foot stands, else 0.
  uint8_t stance;
  // 1 if this sample completed a stride, which is `stride`, else 0.
  uint8_t has_stride;
  // The stride, if there is one; else zeros.
  struct kestirim_pedestrian_stride stride;
} kestirim_pedestrian_state;

// Settings of a tag's tracker.
typedef struct kestirim_tag_config {
  // How well the anchors are known: a `kestirim_calibration`.
  uint32_t calibration;
  // Height of the tag in the room, m.
  float height;
} kestirim_tag_config;

// An anchor: where it is, and by how much it measures too long.
typedef struct kestirim_anchor {
  // Position, m, room: x, y, z.
  float position[3];
  // What its ranges are too long by, m; 0 if that is not known.
  float bias;
} kestirim_anchor;

// One measured distance.
typedef struct kestirim_range {
  // Time of the measurement, µs since any moment.
  uint64_t time_us;
  // The anchor's place in the array that the tracker was made with.
  uint32_t anchor;
  // The distance, m; small negative ones are accepted.
  float range;
} kestirim_range;

// What became of a range.
typedef struct kestirim_range_report {
  // Its outcome.
  kestirim_range_outcome outcome;
  // Measured minus expected, m; 0 without an estimate.
  float innovation;
  // Its variance, m²; 0 without an estimate.
  float variance;
  // Its square by its variance: 1 on average when the model is right.
  float nis;
} kestirim_range_report;

// One sample of an IMU on the tag.
typedef struct kestirim_inertial {
  // Time of the sample, µs, the ranges' clock.
  uint64_t time_us;
  // Acceleration in the body's axes, with or without gravity, m/s². From its changes the tracker tells standing from
  // moving.
  float acceleration[3];
} kestirim_inertial;

// What the wheels do.
typedef struct kestirim_odometry {
  // Time of the measurement, µs, the ranges' clock.
  uint64_t time_us;
  // Mean speed of the wheels, m/s.
  float speed;
  // Difference of their speeds by the track, or the rate of a gyroscope beside them, rad/s.
  float turn_rate;
} kestirim_odometry;

// Health of a tag's tracker in numbers.
typedef struct kestirim_tag_health {
  // State of the position.
  kestirim_tag_state state;
  // Ranges taken in so far.
  uint32_t taken;
  // Ranges left out so far.
  uint32_t rejected;
  // Positions begun anew after the first.
  uint16_t restarts;
  // Anchors heard lately of which nothing is in the way.
  uint8_t heard;
  // 1 if the tag stands still, as far as IMU or wheels tell, else 0.
  uint8_t still;
  // Mean NIS of the last twenty ranges or so: 1 when the model is right.
  float nis;
  // Dilution of precision of the anchors heard; 0 if they do not determine a position.
  float dilution;
} kestirim_tag_health;

// The model of an aircraft near its steady flight and of its sensors: x' = A x + B u, y = C x. Rows one after another.
typedef struct kestirim_uav_model {
  // A: 4 rows of 4.
  double a[4][4];
  // B: 4 rows of 2.
  double b[4][2];
  // C: a row of 4 an output, in whatever unit the output has.
  double c[KESTIRIM_UAV_OUTPUTS][4];
  // Standard deviations of what reaches the aircraft beside elevator (rad) and throttle, a sample.
  double input_sigma[2];
  // Standard deviation of each output, in its unit.
  double output_sigma[KESTIRIM_UAV_OUTPUTS];
  // How long an interval between two samples usually is, s.
  double usual_interval;
} kestirim_uav_model;

// Inputs and outputs of one time, in deviations from the model's steady flight.
typedef struct kestirim_uav_sample {
  // Time of the sample, µs since any moment.
  int64_t time_us;
  // Elevator (rad) and throttle (0 to 1), applied from this time until the next sample.
  double input[2];
  // The outputs, in the order and the units of C's rows.
  double measured[KESTIRIM_UAV_OUTPUTS];
  // A bit an output: 1 if it was measured. The first row's is bit 0; 7 is all three.
  uint32_t present;
} kestirim_uav_sample;

#ifdef __cplusplus
extern "C" {
#endif // __cplusplus

// Bytes that a search takes on this target. An estimate needs 16 kB of stack on a computer, 9 kB on a microcontroller.
size_t kestirim_drone_size(void);

// Alignment of its memory, bytes.
size_t kestirim_drone_align(void);

// Makes a search in memory of at least `kestirim_drone_size()` bytes, in an area with these corners (x, y, m, in either
// sense of rotation), of which there may be `KESTIRIM_MOST_CORNERS`.
//
// Errors: `TOO_MANY`; `GEOMETRY` if the corners enclose nothing; `NOT_FINITE`.
kestirim_status kestirim_drone_init(void *memory,
                                    size_t size,
                                    const float (*corners)[2],
                                    size_t count,
                                    struct kestirim_drone **search);

// Takes in a measurement.
//
// Errors: `NOT_FINITE`; `INVALID_ARGUMENT` if the height is not positive; `IMPLAUSIBLE` beyond 300 dB.
kestirim_status kestirim_drone_update(struct kestirim_drone *search,
                                      const struct kestirim_drone_measurement *measurement);

// Computes where the transmitter is from all measurements that are kept: much work, so ask for it when it is wanted.
//
// Errors: `NO_ESTIMATE` without a measurement; `CONTRADICTORY` if nothing in the area explains them.
kestirim_status kestirim_drone_estimate(const struct kestirim_drone *search,
                                        struct kestirim_drone_place *estimate);

// Whether an estimate can be relied upon: `DROPOUT` with fewer than three measurements. How well they determine the
// place, its standard deviation says.
kestirim_status kestirim_drone_health(const struct kestirim_drone *search,
                                      struct kestirim_health *health);

// Stores the search in a buffer, to be restored after a sleep or by another machine: `KESTIRIM_DRONE_SNAPSHOT` bytes are
// enough, `length` tells how many it took.
//
// Errors: `TOO_SMALL` for the buffer.
kestirim_status kestirim_drone_snapshot(const struct kestirim_drone *search,
                                        uint8_t *buffer,
                                        size_t capacity,
                                        size_t *length);

// Makes the search in memory of at least `kestirim_drone_size()` bytes that `kestirim_drone_snapshot` stored: it goes on
// to the bit as if it had not slept. More bytes than it took, such as a whole page of flash, may be given.
//
// Errors: `NO_SNAPSHOT`; `FOREIGN_SNAPSHOT`; `DAMAGED_SNAPSHOT`.
kestirim_status kestirim_drone_restore(void *memory,
                                       size_t size,
                                       const uint8_t *snapshot,
                                       size_t length,
                                       struct kestirim_drone **search);

// Bytes that a filter takes on this target. An epoch needs 96 kB of stack at most.
size_t kestirim_gnss_size(void);

// Alignment of its memory, bytes.
size_t kestirim_gnss_align(void);

// Makes a filter in memory of at least `kestirim_gnss_size()` bytes, before its first epoch: it starts by itself.
//
// Errors: `NOT_FINITE`.
kestirim_status kestirim_gnss_init(void *memory,
                                   size_t size,
                                   const struct kestirim_gnss_config *config,
                                   struct kestirim_gnss **filter);

// Takes in an epoch, observed at `time` by the receiver's clock: up to `KESTIRIM_MOST_SATELLITES` complete observations. The clock
// of each system beside GPS takes the room of one: what there is no room for is left out.
// `receiver` is the receiver's antenna on L1 and L2, two patterns, or null if it is not known; for the carriers of
// other systems it serves as well. `solution` may be null if it is not wanted. Tides of the ocean are not corrected for.
//
// Errors: `TOO_FEW` satellites; `TOO_MANY`; `GEOMETRY`; `OUT_OF_ORDER`; `CONTRADICTORY`; `NOT_FINITE`;
// `INVALID_ARGUMENT` of carriers, a channel or settings.
kestirim_status kestirim_gnss_update(struct kestirim_gnss *filter,
                                     const struct kestirim_gnss_time *time,
                                     const struct kestirim_gnss_pattern (*receiver)[2],
                                     const struct kestirim_gnss_observation *observations,
                                     size_t count,
                                     struct kestirim_gnss_solution *solution);

// The marker in the last epoch that had a solution, ECEF, m.
//
// Errors: `NO_ESTIMATE`.
kestirim_status kestirim_gnss_position(const struct kestirim_gnss *filter, double (*position)[3]);

// Its standard deviations to the east, north and up, m.
//
// Errors: `NO_ESTIMATE`.
kestirim_status kestirim_gnss_sigma(const struct kestirim_gnss *filter, double (*sigma)[3]);

// Whether it can be relied upon: `NOT_OBSERVABLE` where hardly more is observed than is unknown, `INNOVATIONS` where the
// observations contradict the solution or each other, with `REJECTED` if too many were left out.
//
// Errors: `NO_ESTIMATE`.
kestirim_status kestirim_gnss_health(const struct kestirim_gnss *filter,
                                     struct kestirim_health *health);

// Stores the filter in a buffer, to be restored after a sleep or by another machine: `KESTIRIM_GNSS_SNAPSHOT` bytes are
// enough, `length` tells how many it took.
//
// Errors: `TOO_SMALL` for the buffer.
kestirim_status kestirim_gnss_snapshot(const struct kestirim_gnss *filter,
                                       uint8_t *buffer,
                                       size_t capacity,
                                       size_t *length);

// Makes the filter in memory of at least `kestirim_gnss_size()` bytes that `kestirim_gnss_snapshot` stored: it goes on
// to the bit as if it had not slept. More bytes than it took, such as a whole page of flash, may be given.
//
// Errors: `NO_SNAPSHOT`; `FOREIGN_SNAPSHOT`; `DAMAGED_SNAPSHOT`.
kestirim_status kestirim_gnss_restore(void *memory,
                                      size_t size,
                                      const uint8_t *snapshot,
                                      size_t length,
                                      struct kestirim_gnss **filter);

// Where a satellite was when it sent what was received at `time` by the receiver's clock, with this code (m): by the
// polynomial through eleven samples of its orbit, and the line between two of its clock. Samples are in the order of
// time, evenly spaced ones of the orbit, `KESTIRIM_MOST_PRODUCTS` of either at most.
//
// Errors: `GAP` if the samples do not cover that time; `TOO_MANY`; `NOT_FINITE`.
kestirim_status kestirim_gnss_satellite_at(const struct kestirim_gnss_time *time,
                                           double code,
                                           const struct kestirim_gnss_orbit_sample *orbit,
                                           size_t orbit_count,
                                           const struct kestirim_gnss_clock_sample *clock,
                                           size_t clock_count,
                                           struct kestirim_gnss_satellite *satellite);

// Bytes that a tracker takes on this target.
size_t kestirim_pedestrian_size(void);

// Alignment of its memory, bytes.
size_t kestirim_pedestrian_align(void);

// Makes a tracker in memory of at least `kestirim_pedestrian_size()` bytes, before its first sample. `tracker` is its
// handle from then on, and there is nothing to be freed.
kestirim_status kestirim_pedestrian_init(void *memory,
                                         size_t size,
                                         const struct kestirim_pedestrian_config *config,
                                         struct kestirim_pedestrian **tracker);

// Takes the next sample.
//
// A sample with the time of the last is taken for one that was sent twice and changes nothing.
//
// Errors: `NOT_FINITE`; `IMPLAUSIBLE` beyond 1000 g or 100000 degrees a second; `OUT_OF_ORDER`.
kestirim_status kestirim_pedestrian_update(struct kestirim_pedestrian *tracker,
                                           const struct kestirim_pedestrian_sample *sample);

// The whole estimate after the last sample.
//
// Errors: `NO_ESTIMATE` before the first sample.
kestirim_status kestirim_pedestrian_now(const struct kestirim_pedestrian *tracker,
                                        struct kestirim_pedestrian_state *estimate);

// Ends the walk: writes the stride that led to the stance the foot is in; `stride` may be null.
//
// Errors: `NO_ESTIMATE` if there is no such stride.
kestirim_status kestirim_pedestrian_finish(struct kestirim_pedestrian *tracker,
                                           struct kestirim_pedestrian_stride *stride);

// Position of the sensor after the last sample, m, earth: x, y, z. Zeros until the foot has stood.
//
// Errors: `NO_ESTIMATE` before the first sample.
kestirim_status kestirim_pedestrian_position(const struct kestirim_pedestrian *tracker,
                                             float (*position)[3]);

// Standard deviations of the position, m, earth: x, y, z; those after the last stride.
kestirim_status kestirim_pedestrian_sigma(const struct kestirim_pedestrian *tracker,
                                          float (*sigma)[3]);

// The horizontal path walked, from stance to stance, m.
kestirim_status kestirim_pedestrian_path_length(const struct kestirim_pedestrian *tracker,
                                                float *length);

// Whether the path can be relied upon. `NOT_OBSERVABLE` stands there until the foot has stood still for half a
// second, `SATURATED` if a sensor's range is too small, `UNITS` if g or degrees came for m/s² or rad, `AXES` if they
// are swapped between the two sensors, `DROPOUT` after gaps, `INNOVATIONS` if strides end with too large a velocity.
kestirim_status kestirim_pedestrian_health(const struct kestirim_pedestrian *tracker,
                                           struct kestirim_health *health);

// Stores the tracker in a buffer, to be restored after a sleep or by another machine: `KESTIRIM_PEDESTRIAN_SNAPSHOT` bytes are
// enough, `length` tells how many it took.
//
// Errors: `TOO_SMALL` for the buffer.
kestirim_status kestirim_pedestrian_snapshot(const struct kestirim_pedestrian *tracker,
                                             uint8_t *buffer,
                                             size_t capacity,
                                             size_t *length);

// Makes the tracker in memory of at least `kestirim_pedestrian_size()` bytes that `kestirim_pedestrian_snapshot` stored: it goes on
// to the bit as if it had not slept. More bytes than it took, such as a whole page of flash, may be given.
//
// Errors: `NO_SNAPSHOT`; `FOREIGN_SNAPSHOT`; `DAMAGED_SNAPSHOT`.
kestirim_status kestirim_pedestrian_restore(void *memory,
                                            size_t size,
                                            const uint8_t *snapshot,
                                            size_t length,
                                            struct kestirim_pedestrian **tracker);

// Bytes that a tracker takes on this target.
size_t kestirim_robot_size(void);

// Alignment of its memory, bytes.
size_t kestirim_robot_align(void);

// Makes a tracker in memory of at least `kestirim_robot_size()` bytes, before its first position, for up to
// `KESTIRIM_MOST_ANCHORS` anchors. Ranges name them by their place in this array.
//
// Errors: `TOO_MANY`; `NOT_FINITE`.
kestirim_status kestirim_robot_init(void *memory,
                                    size_t size,
                                    const struct kestirim_tag_config *config,
                                    const struct kestirim_anchor *anchors,
                                    size_t count,
                                    struct kestirim_robot **tracker);

// Takes in a range. `report` may be null if it is not wanted.
//
// Errors: `NO_SUCH_ANCHOR`; `IMPLAUSIBLE` below -1 m or above 200 m; `DUPLICATE`; `OUT_OF_ORDER` if it is more than 0.1 s
// older than the estimate; `NOT_FINITE`.
kestirim_status kestirim_robot_range(struct kestirim_robot *tracker,
                                     const struct kestirim_range *sample,
                                     struct kestirim_range_report *report);

// Takes in a sample of an IMU: whether the tag stands.
//
// Errors: `NOT_FINITE`; `IMPLAUSIBLE` beyond 500 m/s²; `OUT_OF_ORDER`.
kestirim_status kestirim_robot_inertial(struct kestirim_robot *tracker,
                                        const struct kestirim_inertial *sample);

// Takes in a sample of the wheels: speed, and whether it turns. `kestirim_wheels` makes more of them.
//
// Errors: `NOT_FINITE`; `IMPLAUSIBLE` beyond 100 m/s or rad/s; `OUT_OF_ORDER`.
kestirim_status kestirim_robot_odometry(struct kestirim_robot *tracker,
                                        const struct kestirim_odometry *sample);

// Sets the tag's height, m.
//
// Errors: `NOT_FINITE`.
kestirim_status kestirim_robot_set_height(struct kestirim_robot *tracker, float height);

// Position of the tag, m, room: x, y.
//
// Errors: `NO_ESTIMATE` before the first one, or when it is lost.
kestirim_status kestirim_robot_position(const struct kestirim_robot *tracker, float (*position)[2]);

// Velocity of the tag, m/s, room: x, y.
//
// Errors: `NO_ESTIMATE`.
kestirim_status kestirim_robot_velocity(const struct kestirim_robot *tracker, float (*velocity)[2]);

// Standard deviation of the position at a time (µs), m: root of the sum of both axes' variances, with what the anchors'
// constant errors add.
//
// Errors: `NO_ESTIMATE`.
kestirim_status kestirim_robot_sigma(const struct kestirim_robot *tracker,
                                     uint64_t time_us,
                                     float *sigma);

// Whether the position can be relied upon at a time (µs); `details` may be null if they are not wanted.
kestirim_status kestirim_robot_health(const struct kestirim_robot *tracker,
                                      uint64_t time_us,
                                      struct kestirim_health *health,
                                      struct kestirim_tag_health *details);

// Stores the tracker in a buffer, to be restored after a sleep or by another machine: `KESTIRIM_ROBOT_SNAPSHOT` bytes are
// enough, `length` tells how many it took.
//
// Errors: `TOO_SMALL` for the buffer.
kestirim_status kestirim_robot_snapshot(const struct kestirim_robot *tracker,
                                        uint8_t *buffer,
                                        size_t capacity,
                                        size_t *length);

// Makes the tracker in memory of at least `kestirim_robot_size()` bytes that `kestirim_robot_snapshot` stored: it goes on
// to the bit as if it had not slept. More bytes than it took, such as a whole page of flash, may be given.
//
// Errors: `NO_SNAPSHOT`; `FOREIGN_SNAPSHOT`; `DAMAGED_SNAPSHOT`.
kestirim_status kestirim_robot_restore(void *memory,
                                       size_t size,
                                       const uint8_t *snapshot,
                                       size_t length,
                                       struct kestirim_robot **tracker);

// The name of a status, in plain English: a text that lives as long as the program. Of a number that is none,
// "unknown status".
const char *kestirim_status_name(int32_t status);

// Bytes that a filter takes on this target.
size_t kestirim_uav_size(void);

// Alignment of its memory, bytes.
size_t kestirim_uav_align(void);

// The Aerosonde, a small unmanned aircraft, with a pitch gyroscope, a Pitot tube and an attitude reference at 100 Hz: a
// model to begin with. Outputs are pitch rate (rad/s), airspeed (m/s) and pitch angle (rad).
kestirim_status kestirim_uav_aerosonde(struct kestirim_uav_model *model);

// Makes a filter in memory of at least `kestirim_uav_size()` bytes, of which nothing is known yet but the model.
//
// Errors: `NOT_FINITE`; `INVALID_ARGUMENT` if the usual interval is not positive.
kestirim_status kestirim_uav_init(void *memory,
                                  size_t size,
                                  const struct kestirim_uav_model *model,
                                  struct kestirim_uav **filter);

// Takes in a sample. One that is more than a second older than the one before is not late: the clock was set back, and
// the filter begins anew.
//
// Errors: `OUT_OF_ORDER`; `GAP` of more than a million usual intervals; `NOT_FINITE`.
kestirim_status kestirim_uav_update(struct kestirim_uav *filter,
                                    const struct kestirim_uav_sample *sample);

// The estimate at the time of the last sample: angle of attack (rad), pitch rate (rad/s), airspeed (m/s), pitch angle
// (rad), as deviations.
kestirim_status kestirim_uav_estimate(const struct kestirim_uav *filter,
                                      double (*estimate)[4]);

// Standard deviations of the estimate: rad, rad/s, m/s, rad.
kestirim_status kestirim_uav_sigma(const struct kestirim_uav *filter, double (*sigma)[4]);

// Whether the estimate can be relied upon: `INNOVATIONS` if measurements and model have contradicted each other over
// about 200 samples, `REJECTED` if more than a tenth of about 50 samples' measurements were left out.
kestirim_status kestirim_uav_health(const struct kestirim_uav *filter,
                                    struct kestirim_health *health);

// Stores the filter in a buffer, to be restored after a sleep or by another machine: `KESTIRIM_UAV_SNAPSHOT` bytes are
// enough, `length` tells how many it took.
//
// Errors: `TOO_SMALL` for the buffer.
kestirim_status kestirim_uav_snapshot(const struct kestirim_uav *filter,
                                      uint8_t *buffer,
                                      size_t capacity,
                                      size_t *length);

// Makes the filter in memory of at least `kestirim_uav_size()` bytes that `kestirim_uav_snapshot` stored: it goes on
// to the bit as if it had not slept. More bytes than it took, such as a whole page of flash, may be given.
//
// Errors: `NO_SNAPSHOT`; `FOREIGN_SNAPSHOT`; `DAMAGED_SNAPSHOT`.
kestirim_status kestirim_uav_restore(void *memory,
                                     size_t size,
                                     const uint8_t *snapshot,
                                     size_t length,
                                     struct kestirim_uav **filter);

// Bytes that a tracker takes on this target.
size_t kestirim_wheels_size(void);

// Alignment of its memory, bytes.
size_t kestirim_wheels_align(void);

// Makes a tracker in memory of at least `kestirim_wheels_size()` bytes, before its first position, for up to
// `KESTIRIM_MOST_ANCHORS` anchors. Ranges name them by their place in this array.
//
// Errors: `TOO_MANY`; `NOT_FINITE`.
kestirim_status kestirim_wheels_init(void *memory,
                                     size_t size,
                                     const struct kestirim_tag_config *config,
                                     const struct kestirim_anchor *anchors,
                                     size_t count,
                                     struct kestirim_wheels **tracker);

// Takes in a range. `report` may be null if it is not wanted.
//
// Errors: `NO_SUCH_ANCHOR`; `IMPLAUSIBLE` below -1 m or above 200 m; `DUPLICATE`; `OUT_OF_ORDER` if it is more than 0.1 s
// older than the estimate; `NOT_FINITE`.
kestirim_status kestirim_wheels_range(struct kestirim_wheels *tracker,
                                      const struct kestirim_range *sample,
                                      struct kestirim_range_report *report);

// Takes in a sample of the wheels: what they did since the one before. Give all, in order with the ranges.
//
// Errors: `NOT_FINITE`; `IMPLAUSIBLE` beyond 100 m/s or rad/s; `OUT_OF_ORDER`.
kestirim_status kestirim_wheels_odometry(struct kestirim_wheels *tracker,
                                         const struct kestirim_odometry *sample);

// Sets the tag's height, m.
//
// Errors: `NOT_FINITE`.
kestirim_status kestirim_wheels_set_height(struct kestirim_wheels *tracker, float height);

// Position of the tag, m, room: x, y.
//
// Errors: `NO_ESTIMATE` before the first one, or when it is lost.
kestirim_status kestirim_wheels_position(const struct kestirim_wheels *tracker,
                                         float (*position)[2]);

// Standard deviation of the position at a time (µs), m: root of the sum of both axes' variances, with what the anchors'
// constant errors add.
//
// Errors: `NO_ESTIMATE`.
kestirim_status kestirim_wheels_sigma(const struct kestirim_wheels *tracker,
                                      uint64_t time_us,
                                      float *sigma);

// Whether the position can be relied upon at a time (µs); `details` may be null if they are not wanted.
kestirim_status kestirim_wheels_health(const struct kestirim_wheels *tracker,
                                       uint64_t time_us,
                                       struct kestirim_health *health,
                                       struct kestirim_tag_health *details);

// By what the wheels' ways are to be multiplied.
//
// Errors: `NO_ESTIMATE` before it is known.
kestirim_status kestirim_wheels_scale(const struct kestirim_wheels *tracker, float *scale);

// Stores the tracker in a buffer, to be restored after a sleep or by another machine: `KESTIRIM_WHEELS_SNAPSHOT` bytes are
// enough, `length` tells how many it took.
//
// Errors: `TOO_SMALL` for the buffer.
kestirim_status kestirim_wheels_snapshot(const struct kestirim_wheels *tracker,
                                         uint8_t *buffer,
                                         size_t capacity,
                                         size_t *length);

// Makes the tracker in memory of at least `kestirim_wheels_size()` bytes that `kestirim_wheels_snapshot` stored: it goes on
// to the bit as if it had not slept. More bytes than it took, such as a whole page of flash, may be given.
//
// Errors: `NO_SNAPSHOT`; `FOREIGN_SNAPSHOT`; `DAMAGED_SNAPSHOT`.
kestirim_status kestirim_wheels_restore(void *memory,
                                        size_t size,
                                        const uint8_t *snapshot,
                                        size_t length,
                                        struct kestirim_wheels **tracker);

#ifdef __cplusplus
}  // extern "C"
#endif  // __cplusplus

#endif  /* KESTIRIM_H */
