// Kestirim: estimators for localisation, for C and C++.
//
// Objects are in memory that the caller provides: at least kestirim_SYSTEM_size() bytes (at most KESTIRIM_SYSTEM_SIZE,
// for static memory), aligned like a double or an int64_t. kestirim_SYSTEM_init() returns a handle into this memory.
// Nothing is allocated, nothing is global, and nothing has to be freed. Do not copy or move the memory, and do not
// write into it.
//
// Pointers are checked: a kestirim_status reports a null or misaligned pointer, too little memory, and memory that
// holds no object of the expected type. What cannot be checked is up to the caller: memory belongs to the caller and is
// as large as stated; arrays have as many elements as stated; and no two calls use the same object at the same time (in
// an interrupt or in another thread), whereas calls with different objects may. A call that fails changes nothing and
// writes no result.
//
// Units are SI (m, s, rad) unless a field states otherwise. Times are integer microseconds of one clock. Frames are
// named where they matter. Numbers are `float` whatever the library computes with: `float`, or fixed point if it was
// built with the feature `fixed`, for processors without a floating-point unit. GNSS and aircraft models use `double`.


#ifndef KESTIRIM_H
#define KESTIRIM_H

// Made by cbindgen of crates/c: do not edit. `crates/c/tests/c/header.rs` compares it.

#include <stddef.h>
#include <stdint.h>

// Largest number of corners of a search area.
#define KESTIRIM_MOST_CORNERS 16

// Upper bound of the size of a transmitter search on any target, bytes: for static memory.
#define KESTIRIM_DRONE_SIZE 1024

// Upper bound of the size of a transmitter search's snapshot on any target, bytes.
#define KESTIRIM_DRONE_SNAPSHOT (((KESTIRIM_DRONE_SIZE / 4) * 5) + 64)

// Largest number of satellites in an epoch.
#define KESTIRIM_MOST_SATELLITES 12

// Upper bound of the size of a GNSS filter on any target, bytes: for static memory.
#define KESTIRIM_GNSS_SIZE 10240

// Upper bound of the size of a GNSS filter's snapshot on any target, bytes.
#define KESTIRIM_GNSS_SNAPSHOT (((KESTIRIM_GNSS_SIZE / 4) * 5) + 64)

// Largest number of satellites whose ephemerides are kept, of all systems together. A further one is left out until
// another has not been heard for five minutes.
#define KESTIRIM_MOST_BROADCAST 40

// Upper bound of the size of an ephemeris collection on any target, bytes: for static memory.
#define KESTIRIM_GNSS_BROADCAST_SIZE 16384

// Upper bound of the size of corrections on any target, bytes: for static memory.
#define KESTIRIM_GNSS_CORRECTIONS_SIZE 20480

// Largest number of samples of an orbit or a clock: four hours of an orbit with a sample every quarter of an hour.
#define KESTIRIM_MOST_PRODUCTS 16

// Upper bound of the size of a pedestrian tracker on any target, bytes: for static memory.
#define KESTIRIM_PEDESTRIAN_SIZE 2048

// Upper bound of the size of a pedestrian tracker's snapshot on any target, bytes.
#define KESTIRIM_PEDESTRIAN_SNAPSHOT (((KESTIRIM_PEDESTRIAN_SIZE / 4) * 5) + 64)

// Largest number of anchors of a tag tracker.
#define KESTIRIM_MOST_ANCHORS 8

// Upper bound of the size of a tag tracker on any target, bytes: for static memory.
#define KESTIRIM_ROBOT_SIZE 1536

// Upper bound of the size of a tag tracker's snapshot on any target, bytes.
#define KESTIRIM_ROBOT_SNAPSHOT (((KESTIRIM_ROBOT_SIZE / 4) * 5) + 64)

// Number of measured outputs of a flight filter.
#define KESTIRIM_UAV_OUTPUTS 3

// Upper bound of the size of a flight filter on any target, bytes: for static memory.
#define KESTIRIM_UAV_SIZE 2048

// Upper bound of the size of a flight filter's snapshot on any target, bytes.
#define KESTIRIM_UAV_SNAPSHOT (((KESTIRIM_UAV_SIZE / 4) * 5) + 64)

// Upper bound of the size of a wheel tracker on any target, bytes: for static memory.
#define KESTIRIM_WHEELS_SIZE 2048

// Upper bound of the size of a wheel tracker's snapshot on any target, bytes.
#define KESTIRIM_WHEELS_SNAPSHOT (((KESTIRIM_WHEELS_SIZE / 4) * 5) + 64)

// Outcome of a call. If it is not `KESTIRIM_STATUS_OK`, nothing was changed and no result was written.
enum kestirim_status
#if defined(__cplusplus) || __STDC_VERSION__ >= 202311L
  : int32_t
#endif // defined(__cplusplus) || __STDC_VERSION__ >= 202311L
 {
  // The call succeeded.
  KESTIRIM_STATUS_OK = 0,
  // A pointer is null.
  KESTIRIM_STATUS_NULL_POINTER = 1,
  // A pointer is not aligned for its type.
  KESTIRIM_STATUS_MISALIGNED = 2,
  // The memory is too small for the object, or the buffer for the snapshot.
  KESTIRIM_STATUS_TOO_SMALL = 3,
  // The memory holds no object of this type: it was never initialised, or has been overwritten.
  KESTIRIM_STATUS_NOT_INITIALISED = 4,
  // An enumerated argument has an unknown value, or a setting or a number is out of its range.
  KESTIRIM_STATUS_INVALID_ARGUMENT = 5,
  // There is no estimate yet, or it was lost.
  KESTIRIM_STATUS_NO_ESTIMATE = 6,
  // A number is NaN, infinite, or out of the range of the fixed-point format.
  KESTIRIM_STATUS_NOT_FINITE = 7,
  // A measurement has a value that no sensor can have measured.
  KESTIRIM_STATUS_IMPLAUSIBLE = 8,
  // The sample is not later than the last one, or is too old for the estimate.
  KESTIRIM_STATUS_OUT_OF_ORDER = 9,
  // The measurement was already processed.
  KESTIRIM_STATUS_DUPLICATE = 10,
  // No anchor has this number.
  KESTIRIM_STATUS_NO_SUCH_ANCHOR = 11,
  // There are more anchors, corners, satellites or samples than there is room for.
  KESTIRIM_STATUS_TOO_MANY = 12,
  // There are fewer anchors, satellites or words of a navigation message than are needed.
  KESTIRIM_STATUS_TOO_FEW = 13,
  // The measurements contradict each other, or no position explains them.
  KESTIRIM_STATUS_CONTRADICTORY = 14,
  // The time since the last sample is not a multiple of the model's interval; or no ephemeris or product covers the time.
  KESTIRIM_STATUS_GAP = 15,
  // The geometry determines no position, the corners enclose no area, or a matrix is singular.
  KESTIRIM_STATUS_GEOMETRY = 16,
  // The estimator refused the step for another reason.
  KESTIRIM_STATUS_REFUSED = 17,
  // The bytes are not a snapshot.
  KESTIRIM_STATUS_NO_SNAPSHOT = 18,
  // The snapshot is of another type of object, another version of this library, or another number format (`float` or
  // fixed point).
  KESTIRIM_STATUS_FOREIGN_SNAPSHOT = 19,
  // The snapshot was not written completely, or has been altered.
  KESTIRIM_STATUS_DAMAGED_SNAPSHOT = 20,
  // The checksum of the navigation message is wrong, or the message is of another kind.
  KESTIRIM_STATUS_DAMAGED_MESSAGE = 21,
  // The satellite declares its signals unhealthy, or predicts no accuracy.
  KESTIRIM_STATUS_UNHEALTHY = 22,
  // The satellite does not broadcast the group delay for the observed carriers.
  KESTIRIM_STATUS_NO_GROUP_DELAY = 23,
};
#ifndef __cplusplus
#if __STDC_VERSION__ >= 202311L
typedef enum kestirim_status kestirim_status;
#else
typedef int32_t kestirim_status;
#endif // __STDC_VERSION__ >= 202311L
#endif // __cplusplus

// Degree to which an estimate can be relied upon.
enum kestirim_state
#if defined(__cplusplus) || __STDC_VERSION__ >= 202311L
  : uint32_t
#endif // defined(__cplusplus) || __STDC_VERSION__ >= 202311L
 {
  // The estimate is as good as its standard deviation says.
  KESTIRIM_STATE_GOOD = 0,
  // The estimate is worse than with better data; its stated accuracy still holds approximately.
  KESTIRIM_STATE_DEGRADED = 1,
  // The estimate may be wrong by far more than its stated accuracy: do not rely on it.
  KESTIRIM_STATE_BAD = 2,
};
#ifndef __cplusplus
#if __STDC_VERSION__ >= 202311L
typedef enum kestirim_state kestirim_state;
#else
typedef uint32_t kestirim_state;
#endif // __STDC_VERSION__ >= 202311L
#endif // __cplusplus

// What a tracker did with a range.
enum kestirim_range_outcome
#if defined(__cplusplus) || __STDC_VERSION__ >= 202311L
  : uint32_t
#endif // defined(__cplusplus) || __STDC_VERSION__ >= 202311L
 {
  // The range is stored for a first position, which needs more ranges or is still being searched for.
  KESTIRIM_RANGE_OUTCOME_COLLECTED = 0,
  // With this range a first position was found, or a new one after the tracker was lost.
  KESTIRIM_RANGE_OUTCOME_STARTED = 1,
  // The range was used with its full weight.
  KESTIRIM_RANGE_OUTCOME_TAKEN = 2,
  // The range was used with a reduced weight: it is longer or shorter than expected.
  KESTIRIM_RANGE_OUTCOME_WEAKENED = 3,
  // The range was rejected.
  KESTIRIM_RANGE_OUTCOME_REJECTED = 4,
  // The range was used although it does not fit: too many had been rejected.
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
  // Ranges arrive and are consistent.
  KESTIRIM_TAG_STATE_TRACKING = 1,
  // No range arrived for a second, or for two rounds of the anchors if those take longer: the position is that
  // after the last sample, and its standard deviation grows with the time since.
  KESTIRIM_TAG_STATE_COASTING = 2,
  // The position has become useless: the next ranges determine a new one.
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
  // Calibrated unit (`MicroStrain`, Xsens, NGIMU): its gyroscope starts within 3 mrad/s of zero.
  KESTIRIM_SENSOR_INDUSTRIAL = 0,
  // Bare chip (MPU-6050, MPU-9250, BNO055, LSM6DS): its gyroscope may start 0.1 rad/s off.
  KESTIRIM_SENSOR_CONSUMER = 1,
};
#ifndef __cplusplus
#if __STDC_VERSION__ >= 202311L
typedef enum kestirim_sensor kestirim_sensor;
#else
typedef uint32_t kestirim_sensor;
#endif // __STDC_VERSION__ >= 202311L
#endif // __cplusplus

// Reasons why an estimate is not good: the bits of `kestirim_health.reasons`.
enum kestirim_reason
#if defined(__cplusplus) || __STDC_VERSION__ >= 202311L
  : uint32_t
#endif // defined(__cplusplus) || __STDC_VERSION__ >= 202311L
 {
  // A sensor reached the end of its range.
  KESTIRIM_REASON_SATURATED = 1,
  // A sensor keeps repeating the same value.
  KESTIRIM_REASON_STUCK = (1 << 1),
  // Data are missing, or there are too few.
  KESTIRIM_REASON_DROPOUT = (1 << 2),
  // More measurements than usual contradict the estimate and were rejected.
  KESTIRIM_REASON_REJECTED = (1 << 3),
  // A quantity that the estimate needs is not observable in the data.
  KESTIRIM_REASON_NOT_OBSERVABLE = (1 << 4),
  // Time stamps run too fast or too slow, some data are later than others, or products belong to another time.
  KESTIRIM_REASON_TIME = (1 << 5),
  // Data seem to be in another unit or to have another sign.
  KESTIRIM_REASON_UNITS = (1 << 6),
  // Axes seem to be swapped or mirrored.
  KESTIRIM_REASON_AXES = (1 << 7),
  // Measurements and geometry contradict each other.
  KESTIRIM_REASON_GEOMETRY = (1 << 8),
  // One anchor, or two that seem swapped, contradict the others.
  KESTIRIM_REASON_ANCHOR = (1 << 9),
  // The height that was given contradicts the measurements.
  KESTIRIM_REASON_HEIGHT = (1 << 10),
  // The innovations of the measurements exceed their bound.
  KESTIRIM_REASON_INNOVATIONS = (1 << 11),
  // The estimate left the range of its number format.
  KESTIRIM_REASON_RANGE = (1 << 12),
};
#ifndef __cplusplus
#if __STDC_VERSION__ >= 202311L
typedef enum kestirim_reason kestirim_reason;
#else
typedef uint32_t kestirim_reason;
#endif // __STDC_VERSION__ >= 202311L
#endif // __cplusplus

// Calibration of the anchors' ranges.
enum kestirim_calibration
#if defined(__cplusplus) || __STDC_VERSION__ >= 202311L
  : uint32_t
#endif // defined(__cplusplus) || __STDC_VERSION__ >= 202311L
 {
  // Uncalibrated anchors: ranges are too long by a decimetre or two.
  KESTIRIM_CALIBRATION_UNCALIBRATED = 0,
  // Calibrated anchors: the bias of each is known to 5 cm.
  KESTIRIM_CALIBRATION_CALIBRATED = 1,
};
#ifndef __cplusplus
#if __STDC_VERSION__ >= 202311L
typedef enum kestirim_calibration kestirim_calibration;
#else
typedef uint32_t kestirim_calibration;
#endif // __STDC_VERSION__ >= 202311L
#endif // __cplusplus

// Pairs of carriers on which a satellite can be observed.
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

// Navigation messages from which ephemerides can be collected.
enum kestirim_gnss_message
#if defined(__cplusplus) || __STDC_VERSION__ >= 202311L
  : uint32_t
#endif // defined(__cplusplus) || __STDC_VERSION__ >= 202311L
 {
  // LNAV of GPS on L1 C/A: a subframe of 10 words of 30 bits, right aligned, parity last.
  KESTIRIM_GNSS_MESSAGE_LNAV = 0,
  // I/NAV of Galileo on E1-B or E5b-I: a page of 8 words of 32 bits, the even part first.
  KESTIRIM_GNSS_MESSAGE_INAV = 1,
  // D1 of BeiDou on B1I, B2I or B3I: a subframe of 10 words of 30 bits, right aligned, parity last. The
  // geostationary C01 to C05 and C59 to C63 send D2 instead.
  KESTIRIM_GNSS_MESSAGE_D1 = 2,
};
#ifndef __cplusplus
#if __STDC_VERSION__ >= 202311L
typedef enum kestirim_gnss_message kestirim_gnss_message;
#else
typedef uint32_t kestirim_gnss_message;
#endif // __STDC_VERSION__ >= 202311L
#endif // __cplusplus

// A transmitter search: locates a transmitter of unknown power over open ground, from the levels that a drone
// receives.
//
// Places are coordinates in a horizontal plane (such as east and north), m, with one origin for drone and transmitter.
typedef struct kestirim_drone kestirim_drone;

// A GNSS filter: precise point positioning of a receiver, to a centimetre, from its dual-frequency observations and
// the orbits and clocks of a service. It computes in double precision, for processors with enough memory.
//
// Frame: Earth-centred, Earth-fixed (ECEF, that of the orbits), m; standard deviations are to the east, north and up.
// Times are in GPS time.
typedef struct kestirim_gnss kestirim_gnss;

// An ephemeris collection: ephemerides assembled from the navigation messages that satellites broadcast. With them a
// receiver needs no service, and its position is good to metres. It computes in double precision, for processors with
// enough memory.
typedef struct kestirim_gnss_broadcast kestirim_gnss_broadcast;

// Corrections: those of a service (SSR in RTCM 3) for the satellites of an ephemeris collection. With them positions become as
// good as the service is, a decimetre or less, without files. The filter's `broadcast` is 1 with them, too. It computes in double precision, for processors with enough memory.
typedef struct kestirim_gnss_corrections kestirim_gnss_corrections;

// A pedestrian tracker: estimates the path of a walking foot from the IMU on it.
//
// Frames: `body` has the IMU's axes, right-handed. `earth` has z up; its origin and its heading are those of the
// sensor when the foot first stood.
typedef struct kestirim_pedestrian kestirim_pedestrian;

// A tag tracker: estimates position and velocity of a tag in the plane, at a known height, from single ranges to
// anchors in any order, optionally with an IMU and wheels.
//
// Frame: `room` has the axes in which the anchors are given, right-handed with z up, m.
typedef struct kestirim_robot kestirim_robot;

// A flight filter: a Kalman filter of an aircraft's longitudinal motion, for samples at any times, with gaps and
// missing outputs.
//
// States: angle of attack (rad), pitch rate (rad/s), airspeed (m/s), pitch angle (rad). Inputs: elevator (rad),
// throttle (0 to 1). All are deviations from the steady flight at which the model was linearised: subtract its values
// from measurements and inputs, and add them to the estimate. The motion is in a vertical plane, in the body's axes.
typedef struct kestirim_uav kestirim_uav;

// A wheel tracker: estimates the position of a tag in the plane on a robot with wheel odometry. The wheels drive the
// prediction, the ranges correct it. The wheels' scale, the gain and drift of their turns, and the heading are
// estimated: the heading need not be known.
//
// Frame: `room` has the axes in which the anchors are given, right-handed with z up, m.
typedef struct kestirim_wheels kestirim_wheels;

// A level that the drone received from the transmitter, and where.
typedef struct kestirim_drone_measurement {
  // Place of the drone, m: x, y.
  float place[2];
  // Height of the drone above the transmitter, m.
  float height;
  // Received level, dBm or dB relative to any reference that is the same for all measurements.
  float level;
} kestirim_drone_measurement;

// Whether an estimate can be relied upon, and all reasons why it cannot.
typedef struct kestirim_health {
  // Degree to which it can be relied upon: the state of the worst reason.
  kestirim_state state;
  // The reasons, one bit each: `kestirim_reason`.
  uint32_t reasons;
} kestirim_health;

// Estimated place of the transmitter.
typedef struct kestirim_drone_place {
  // Place of the transmitter, m: x, y.
  float place[2];
  // Standard deviation of the place, m: the root of the sum of both axes' variances.
  float sigma;
  // Level received at one metre from the transmitter, in the measurements' unit.
  float level;
  // Whether the place can be relied upon: `DROPOUT` with fewer than three measurements, `INNOVATIONS` if the levels show a step,
  // as after a change of the receiver's gain. How well the measurements determine the place is shown by its standard deviation.
  struct kestirim_health health;
} kestirim_drone_place;

// Settings of a GNSS filter.
typedef struct kestirim_gnss_config {
  // Process noise of a moving receiver: the variance added to each coordinate per second, m²/s (1e4 for any motion).
  // 0 for a receiver at rest.
  double process_noise;
  // Elevation mask, rad: lower satellites are not used. 0.14 is 8 degrees.
  double elevation_mask;
  // UT1 (or UTC) minus GPS time, s: the negative number of leap seconds since 1980, -18 since 2017.
  double ut1_minus_gps;
  // Vector from the marker to the antenna's reference point, m: east, north, up.
  double eccentricity[3];
  // Source of orbits and clocks: 0 for the products of a service, 1 for the satellites' broadcast ephemerides, corrected or not
  // (`kestirim_gnss_corrections_at`, `kestirim_gnss_broadcast_at`), whose errors persist for hours.
  uint8_t broadcast;
} kestirim_gnss_config;

// An instant in GPS time.
typedef struct kestirim_gnss_time {
  // The day, as a modified Julian date.
  int32_t day;
  // The second of the day.
  double second;
} kestirim_gnss_time;

// Phase centre of an antenna on one frequency, as an ANTEX file describes it.
typedef struct kestirim_gnss_pattern {
  // Mean phase centre, m: for a receiver's antenna north, east and up of its reference point; for a satellite's
  // along X, Y and Z of its body.
  double offset[3];
  // First angle of the grid, degrees: from the zenith (receiver) or nadir (satellite).
  double first;
  // Step of the grid's zenith or nadir angles, degrees.
  double step;
  // Azimuth-independent phase centre variation at each angle of the grid, m: `count` numbers.
  const double *mean;
  // Number of angles of the grid.
  size_t count;
  // Step of the azimuths, degrees; 0 if the grid has none.
  double azimuth_step;
  // Phase centre variations that depend on the azimuth, m: a row like `mean` for each azimuth from 0 to 360 degrees,
  // one after the other.
  const double *by_azimuth;
  // Total number of values in `by_azimuth`; 0 if the grid has no azimuths.
  size_t azimuth_count;
} kestirim_gnss_pattern;

// State of a satellite at the time of transmission.
typedef struct kestirim_gnss_satellite {
  // Position of the centre of mass, ECEF at the time of transmission, m; with broadcast ephemerides that of the
  // antenna's phase centre.
  double position[3];
  // Velocity of the satellite, m/s, inertial or relative to the Earth.
  double velocity[3];
  // Satellite clock minus GPS time, s, without the relativistic effect of the eccentric orbit.
  double clock;
  // Interval between the two clock samples around the time of transmission, s; 0 if the clock is not interpolated.
  double clock_interval;
  // Time to the nearer of the two clock samples, s.
  double clock_distance;
  // Standard deviation of a range due to this orbit and clock, m, as the satellite broadcasts it; 0 for a service's.
  double accuracy;
} kestirim_gnss_satellite;

// Observation of one satellite by the receiver in an epoch.
typedef struct kestirim_gnss_observation {
  // Number of the satellite, unique among all systems: for example the PRN for GPS, 100 plus the number for Galileo.
  uint8_t satellite;
  // 1 if the receiver reports a loss of lock since the epoch with a position in which this satellite was last given, else 0.
  uint8_t lock_lost;
  // Frequency channel of a GLONASS satellite, -7 to 6; 0 for other systems.
  int8_t channel;
  // The two observed carriers: a `kestirim_gnss_carriers`.
  uint32_t carriers;
  // Code observations (pseudoranges) on both carriers, m.
  double code[2];
  // Carrier phases on both carriers, cycles.
  double phase[2];
  // State of the satellite at the time of transmission.
  struct kestirim_gnss_satellite state;
  // Antenna of the satellite on both carriers: two patterns, or null if they are unknown.
  const struct kestirim_gnss_pattern (*antenna)[2];
} kestirim_gnss_observation;

// Solution of a GNSS filter for one epoch.
typedef struct kestirim_gnss_solution {
  // Position of the marker, ECEF, m, free of tides.
  double position[3];
  // Standard deviations of the position to the east, north and up, m.
  double sigma[3];
  // Receiver clock minus GPS time, m.
  double clock;
  // Wet zenith delay of the troposphere, m.
  double wet_delay;
  // Whether the solution can be relied upon.
  struct kestirim_health health;
  // 1 if the ambiguities are known: the standard deviation of the position is below 10 cm; else 0.
  uint8_t converged;
  // Number of satellites above the elevation mask.
  uint8_t satellites;
  // Number of observations (codes and phases) that had less than their full weight.
  uint8_t treated;
} kestirim_gnss_solution;

// One sample of a satellite's precise orbit (SP3).
typedef struct kestirim_gnss_orbit_sample {
  // Time of the sample.
  struct kestirim_gnss_time time;
  // Position of the satellite's centre of mass, ECEF at the time of the sample, m.
  double position[3];
} kestirim_gnss_orbit_sample;

// One sample of a satellite's precise clock (CLK, SP3).
typedef struct kestirim_gnss_clock_sample {
  // Time of the sample.
  struct kestirim_gnss_time time;
  // Satellite clock minus GPS time, s.
  double bias;
} kestirim_gnss_clock_sample;

// Settings of a pedestrian tracker: the sensor and its mounting on the foot.
typedef struct kestirim_pedestrian_config {
  // Class of the IMU: a `kestirim_sensor`.
  uint32_t sensor;
  // Height of the sensor above the ball of the foot, about which the foot rolls in stance, m. 0 treats a standing
  // foot as motionless.
  float contact_height;
} kestirim_pedestrian_config;

// One sample of the foot's IMU.
typedef struct kestirim_pedestrian_sample {
  // Time of the sample, µs since any epoch.
  uint64_t time_us;
  // Specific force, as an accelerometer measures it, m/s², body frame: +9.8 upwards at rest.
  float specific_force[3];
  // Angular rate, as a gyroscope measures it, rad/s, body frame.
  float angular_rate[3];
} kestirim_pedestrian_sample;

// A stride: from one stance of the foot to the next.
typedef struct kestirim_pedestrian_stride {
  // End of the stance at which the stride arrived, µs on the samples' clock.
  uint64_t time_us;
  // Position of the stance at which the stride arrived, m, earth frame.
  float position[3];
  // Horizontal distance from the preceding stance, m.
  float length;
  // Time since the end of the preceding stance, s.
  float duration;
  // Change of direction from the preceding stride, rad, anticlockwise from above; 0 for the first stride.
  float heading_change;
} kestirim_pedestrian_stride;

// Estimate of the foot's state after a sample.
typedef struct kestirim_pedestrian_state {
  // Time of the sample, µs on the samples' clock.
  uint64_t time_us;
  // Position of the sensor, m, earth frame.
  float position[3];
  // Velocity of the sensor, m/s, earth frame.
  float velocity[3];
  // Orientation of the sensor, from the body to the earth frame: quaternion w, x, y, z.
  float orientation[4];
  // 1 if the foot stands, else 0.
  uint8_t stance;
  // 1 if this sample completed a stride, described by `stride`; else 0.
  uint8_t has_stride;
  // The completed stride; zeros if `has_stride` is 0.
  struct kestirim_pedestrian_stride stride;
} kestirim_pedestrian_state;

// Settings of a tag tracker or wheel tracker.
typedef struct kestirim_tag_config {
  // Calibration of the anchors: a `kestirim_calibration`.
  uint32_t calibration;
  // Height of the tag in the room frame, m.
  float height;
  // Bounds of the tag's position in the room frame, m: x, y of two opposite corners; all zero if there are none. Between the two
  // sides of a line of anchors they decide alone.
  float room[4];
} kestirim_tag_config;

// An anchor, with its position and range bias.
typedef struct kestirim_anchor {
  // Position of the anchor, m, room frame: x, y, z.
  float position[3];
  // Bias of its ranges, m, positive if they are too long; 0 if unknown.
  float bias;
} kestirim_anchor;

// One range: the measured distance from the tag to an anchor.
typedef struct kestirim_range {
  // Time of the measurement, µs since any epoch.
  uint64_t time_us;
  // Index of the anchor in the array with which the tracker was created.
  uint32_t anchor;
  // The distance, m; small negative values are accepted.
  float range;
} kestirim_range;

// Outcome and innovation of a range.
typedef struct kestirim_range_report {
  // What the tracker did with the range.
  kestirim_range_outcome outcome;
  // Innovation of the range, measured minus expected, m; 0 without an estimate.
  float innovation;
  // Variance of the innovation, m²; 0 without an estimate.
  float variance;
  // Normalised innovation squared (NIS): the square of the innovation over its variance, 1 on average if the model
  // is right; 0 without an estimate.
  float nis;
} kestirim_range_report;

// One sample of an IMU that is fixed to the tag.
typedef struct kestirim_inertial {
  // Time of the sample, µs on the ranges' clock.
  uint64_t time_us;
  // Acceleration in the body's axes, with or without gravity, m/s². From its changes the tracker distinguishes
  // standing from moving.
  float acceleration[3];
} kestirim_inertial;

// One sample of wheel odometry.
typedef struct kestirim_odometry {
  // Time of the measurement, µs on the ranges' clock.
  uint64_t time_us;
  // Mean speed of the wheels, m/s.
  float speed;
  // Turn rate, rad/s: the difference of the wheels' speeds over the track, or the rate of a gyroscope.
  float turn_rate;
} kestirim_odometry;

// Health of a tag tracker or wheel tracker in numbers.
typedef struct kestirim_tag_health {
  // State of the position.
  kestirim_tag_state state;
  // Number of ranges used so far.
  uint32_t taken;
  // Number of ranges rejected so far.
  uint32_t rejected;
  // Number of positions begun after the first.
  uint16_t restarts;
  // Number of anchors heard within the last second, or two rounds of the anchors if those take longer, except
  // blocked ones, whose ranges have been too long for a while.
  uint8_t heard;
  // 1 if the tag stands still according to the IMU or the wheels, else 0.
  uint8_t still;
  // Mean normalised innovation squared of about the last twenty ranges that were used: 1 if the model is right.
  float nis;
  // Dilution of precision of the anchors heard; 0 if they do not determine a position.
  float dilution;
} kestirim_tag_health;

// Linear model of an aircraft near its steady flight and of its sensors: x' = A x + B u, y = C x. Matrices are
// row-major.
typedef struct kestirim_uav_model {
  // State matrix A: 4 rows of 4.
  double a[4][4];
  // Input matrix B: 4 rows of 2.
  double b[4][2];
  // Output matrix C: one row of 4 per output, in the unit of that output.
  double c[KESTIRIM_UAV_OUTPUTS][4];
  // Standard deviations, per sample, of the noise on the inputs elevator (rad) and throttle.
  double input_sigma[2];
  // Standard deviation of each measured output, in its unit.
  double output_sigma[KESTIRIM_UAV_OUTPUTS];
  // Usual interval between two samples, s.
  double usual_interval;
} kestirim_uav_model;

// Inputs and outputs at one time, as deviations from the model's steady flight.
typedef struct kestirim_uav_sample {
  // Time of the sample, µs since any epoch.
  int64_t time_us;
  // Inputs elevator (rad) and throttle (0 to 1), applied from this time until the next sample.
  double input[2];
  // Measured outputs, in the order and the units of C's rows.
  double measured[KESTIRIM_UAV_OUTPUTS];
  // Which outputs were measured, one bit each: bit 0 for C's first row; 7 for all three.
  uint32_t present;
} kestirim_uav_sample;

#ifdef __cplusplus
extern "C" {
#endif // __cplusplus

// Size of a transmitter search on this target, bytes. An estimate needs 16 kB of stack on a computer, 9 kB on a
// microcontroller.
size_t kestirim_drone_size(void);

// Alignment of the transmitter search's memory on this target, bytes.
size_t kestirim_drone_align(void);

// Creates a transmitter search in memory of at least `kestirim_drone_size()` bytes, for an area with these corners (x,
// y, m, in either sense of rotation), at most `KESTIRIM_MOST_CORNERS`.
//
// Errors: `TOO_MANY`; `GEOMETRY` if the corners enclose no area; `NOT_FINITE`.
kestirim_status kestirim_drone_init(void *memory,
                                    size_t size,
                                    const float (*corners)[2],
                                    size_t count,
                                    struct kestirim_drone **search);

// Adds a measurement of the transmitter's level.
//
// Errors: `NOT_FINITE`; `INVALID_ARGUMENT` if the height is not positive; `IMPLAUSIBLE` beyond 300 dB.
kestirim_status kestirim_drone_update(struct kestirim_drone *search,
                                      const struct kestirim_drone_measurement *measurement);

// Estimates the place of the transmitter from all measurements that are kept. This takes much computing time: call it
// only when a place is needed.
//
// Errors: `NO_ESTIMATE` without a measurement; `CONTRADICTORY` if no place in the area explains the measurements.
kestirim_status kestirim_drone_estimate(const struct kestirim_drone *search,
                                        struct kestirim_drone_place *estimate);

// Stores the transmitter search in a buffer, to be restored after a sleep or on another machine.
// `KESTIRIM_DRONE_SNAPSHOT` bytes are enough; `length` receives the number of bytes used.
//
// Errors: `TOO_SMALL` for the buffer.
kestirim_status kestirim_drone_snapshot(const struct kestirim_drone *search,
                                        uint8_t *buffer,
                                        size_t capacity,
                                        size_t *length);

// Restores a transmitter search from a snapshot that `kestirim_drone_snapshot` stored, in memory of at least
// `kestirim_drone_size()` bytes. It continues bit for bit as if there had been no interruption. `length` may exceed
// the snapshot, such as a whole page of flash.
//
// Errors: `NO_SNAPSHOT`; `FOREIGN_SNAPSHOT`; `DAMAGED_SNAPSHOT`.
kestirim_status kestirim_drone_restore(void *memory,
                                       size_t size,
                                       const uint8_t *snapshot,
                                       size_t length,
                                       struct kestirim_drone **search);

// Size of a GNSS filter on this target, bytes. An epoch needs at most 96 kB of stack.
size_t kestirim_gnss_size(void);

// Alignment of the GNSS filter's memory on this target, bytes.
size_t kestirim_gnss_align(void);

// Creates a GNSS filter in memory of at least `kestirim_gnss_size()` bytes. It finds its first position by itself.
//
// Errors: `NOT_FINITE`; `INVALID_ARGUMENT`.
kestirim_status kestirim_gnss_init(void *memory,
                                   size_t size,
                                   const struct kestirim_gnss_config *config,
                                   struct kestirim_gnss **filter);

// Processes an epoch, observed at `time` by the receiver's clock: up to `KESTIRIM_MOST_SATELLITES` complete
// observations. The clock of each system other than GPS takes the room of one satellite; satellites without room are
// left out. `receiver` is the receiver's antenna on L1 and L2, two patterns, or null if it is unknown; it is also used
// for the carriers of other systems. `solution` may be null. Ocean loading and the pole tide are not corrected for.
//
// Errors: `TOO_FEW` satellites; `TOO_MANY`; `GEOMETRY`; `OUT_OF_ORDER`; `CONTRADICTORY`; `NOT_FINITE`;
// `INVALID_ARGUMENT` for carriers, a channel, an accuracy or settings.
kestirim_status kestirim_gnss_update(struct kestirim_gnss *filter,
                                     const struct kestirim_gnss_time *time,
                                     const struct kestirim_gnss_pattern (*receiver)[2],
                                     const struct kestirim_gnss_observation *observations,
                                     size_t count,
                                     struct kestirim_gnss_solution *solution);

// Position of the marker in the last epoch that had a solution, ECEF, m.
//
// Errors: `NO_ESTIMATE` before the first solution.
kestirim_status kestirim_gnss_position(const struct kestirim_gnss *filter, double (*position)[3]);

// Standard deviations of the marker's position to the east, north and up, in the last epoch that had a solution, m.
//
// Errors: `NO_ESTIMATE` before the first solution.
kestirim_status kestirim_gnss_sigma(const struct kestirim_gnss *filter,
                                    double (*sigma)[3]);

// Whether the last solution can be relied upon. Reasons why not: `NOT_OBSERVABLE` if hardly more observations are left
// than unknowns; `INNOVATIONS` if the observations contradict the solution, each other or earlier solutions, together
// with `REJECTED` if too many were rejected.
//
// Errors: `NO_ESTIMATE` before the first solution.
kestirim_status kestirim_gnss_health(const struct kestirim_gnss *filter,
                                     struct kestirim_health *health);

// Stores the GNSS filter in a buffer, to be restored after a sleep or on another machine. `KESTIRIM_GNSS_SNAPSHOT`
// bytes are enough; `length` receives the number of bytes used.
//
// Errors: `TOO_SMALL` for the buffer.
kestirim_status kestirim_gnss_snapshot(const struct kestirim_gnss *filter,
                                       uint8_t *buffer,
                                       size_t capacity,
                                       size_t *length);

// Restores a GNSS filter from a snapshot that `kestirim_gnss_snapshot` stored, in memory of at least
// `kestirim_gnss_size()` bytes. It continues bit for bit as if there had been no interruption. `length` may exceed
// the snapshot, such as a whole page of flash.
//
// Errors: `NO_SNAPSHOT`; `FOREIGN_SNAPSHOT`; `DAMAGED_SNAPSHOT`.
kestirim_status kestirim_gnss_restore(void *memory,
                                      size_t size,
                                      const uint8_t *snapshot,
                                      size_t length,
                                      struct kestirim_gnss **filter);

// Size of an ephemeris collection on this target, bytes.
size_t kestirim_gnss_broadcast_size(void);

// Alignment of an ephemeris collection's memory on this target, bytes.
size_t kestirim_gnss_broadcast_align(void);

// Creates an ephemeris collection without satellites in memory of at least `kestirim_gnss_broadcast_size()` bytes.
kestirim_status kestirim_gnss_broadcast_init(void *memory,
                                             size_t size,
                                             struct kestirim_gnss_broadcast **broadcast);

// Processes a part of a satellite's navigation message, as a receiver outputs it (UBX-RXM-SFRBX): `message` is a
// `kestirim_gnss_message`, `words` are its `count` words, and `received` is the time of the last epoch, which
// determines the week. `satellite` is the same number as in the satellite's observations. `complete` receives 1 if the
// part completes an ephemeris, else 0; it may be null.
//
// Errors: `TOO_FEW` words; `DAMAGED_MESSAGE` for a wrong checksum, an alert, or a part of another message, all of
// which occur in streams: continue with the next part; `INVALID_ARGUMENT` for an unknown message; `NOT_FINITE`.
kestirim_status kestirim_gnss_broadcast_take(struct kestirim_gnss_broadcast *broadcast,
                                             uint8_t satellite,
                                             uint32_t message,
                                             const uint32_t *words,
                                             size_t count,
                                             const struct kestirim_gnss_time *received,
                                             uint8_t *complete);

// State of a satellite at the transmission of a signal, from its broadcast ephemeris. `received` is the time of
// reception by the receiver's clock, `code` the code observation on the first carrier (m), and `on` the two observed
// carriers, a `kestirim_gnss_carriers`. The position is that of the antenna's phase centre, so `antenna` must be null
// in the observation.
//
// Errors: `GAP` while no ephemeris is complete or valid at that time; `UNHEALTHY`; `NO_GROUP_DELAY` if the message has
// none for these carriers; `INVALID_ARGUMENT` for carriers; `NOT_FINITE`.
kestirim_status kestirim_gnss_broadcast_at(const struct kestirim_gnss_broadcast *broadcast,
                                           uint8_t satellite,
                                           uint32_t on,
                                           const struct kestirim_gnss_time *received,
                                           double code,
                                           struct kestirim_gnss_satellite *state);

// Size of corrections on this target, bytes.
size_t kestirim_gnss_corrections_size(void);

// Alignment of the memory of corrections on this target, bytes.
size_t kestirim_gnss_corrections_align(void);

// Creates corrections of no satellite in memory of at least `kestirim_gnss_corrections_size()` bytes.
kestirim_status kestirim_gnss_corrections_init(void *memory,
                                               size_t size,
                                               struct kestirim_gnss_corrections **corrections);

// Processes a frame of RTCM 3, from its preamble to its checksum: messages 1057, 1058 and 1060 of GPS, 1240, 1241 and 1243 of
// Galileo, and 4076 of the IGS for both. `broadcast` has the ephemerides received until now, and `received` is the time of the
// last epoch, which determines the week. In it and in observations, satellite n of GPS has the number n + `gps`, and satellite n
// of Galileo n + `galileo`; a satellite whose number would exceed 255 is left out. Corrections of codes are not applied.
//
// Errors: `DAMAGED_MESSAGE` for a wrong checksum or another message, both of which occur in streams: continue with the next
// frame; `NOT_FINITE`.
kestirim_status kestirim_gnss_corrections_take(struct kestirim_gnss_corrections *corrections,
                                               const struct kestirim_gnss_broadcast *broadcast,
                                               const uint8_t *frame,
                                               size_t length,
                                               uint8_t gps,
                                               uint8_t galileo,
                                               const struct kestirim_gnss_time *received);

// State of a satellite at the transmission of a signal, from its corrected ephemeris. `broadcast` has the ephemerides received
// until now, by which the satellite may be unhealthy; `received` is the time of reception by
// the receiver's clock, and `code` the code observation on the first carrier (m). The position is that of the antenna's phase
// centre, so `antenna` must be null in the observation.
//
// Errors: `GAP` while no corrections of a received ephemeris serve at that time; `UNHEALTHY`; `NOT_FINITE`.
kestirim_status kestirim_gnss_corrections_at(const struct kestirim_gnss_corrections *corrections,
                                             const struct kestirim_gnss_broadcast *broadcast,
                                             uint8_t satellite,
                                             const struct kestirim_gnss_time *received,
                                             double code,
                                             struct kestirim_gnss_satellite *state);

// State of a satellite at the transmission of a signal, from its precise orbit and clock. `time` is the time of
// reception by the receiver's clock, `code` the code observation (m). The orbit is interpolated by the polynomial
// through eleven samples, the clock linearly between two. Samples are in the order of time, those of the orbit evenly
// spaced, at most `KESTIRIM_MOST_PRODUCTS` of each.
//
// Errors: `GAP` if the samples do not cover the time of transmission; `TOO_MANY`; `NOT_FINITE`.
kestirim_status kestirim_gnss_satellite_at(const struct kestirim_gnss_time *time,
                                           double code,
                                           const struct kestirim_gnss_orbit_sample *orbit,
                                           size_t orbit_count,
                                           const struct kestirim_gnss_clock_sample *clock,
                                           size_t clock_count,
                                           struct kestirim_gnss_satellite *satellite);

// Size of a pedestrian tracker on this target, bytes.
size_t kestirim_pedestrian_size(void);

// Alignment of the pedestrian tracker's memory on this target, bytes.
size_t kestirim_pedestrian_align(void);

// Creates a pedestrian tracker in memory of at least `kestirim_pedestrian_size()` bytes. `tracker` receives its
// handle; nothing has to be freed.
kestirim_status kestirim_pedestrian_init(void *memory,
                                         size_t size,
                                         const struct kestirim_pedestrian_config *config,
                                         struct kestirim_pedestrian **tracker);

// Processes the next sample of the foot's IMU.
//
// A sample with the time of the last one counts as a repetition and changes nothing.
//
// Errors: `NOT_FINITE`; `IMPLAUSIBLE` beyond 1000 g or 100000 degrees per second; `OUT_OF_ORDER`.
kestirim_status kestirim_pedestrian_update(struct kestirim_pedestrian *tracker,
                                           const struct kestirim_pedestrian_sample *sample);

// The complete estimate of the foot's state after the last sample.
//
// Errors: `NO_ESTIMATE` before the first sample.
kestirim_status kestirim_pedestrian_now(const struct kestirim_pedestrian *tracker,
                                        struct kestirim_pedestrian_state *estimate);

// Ends the walk: completes the stride that led to the present stance, and writes it to `stride`, which may be null.
//
// Errors: `NO_ESTIMATE` if there is no such stride.
kestirim_status kestirim_pedestrian_finish(struct kestirim_pedestrian *tracker,
                                           struct kestirim_pedestrian_stride *stride);

// Position of the foot's sensor after the last sample, m, earth frame: x, y, z. Zeros until the foot has stood.
//
// Errors: `NO_ESTIMATE` before the first sample.
kestirim_status kestirim_pedestrian_position(const struct kestirim_pedestrian *tracker,
                                             float (*position)[3]);

// Standard deviations of the foot's position after the last stride, m, earth frame: x, y, z.
kestirim_status kestirim_pedestrian_sigma(const struct kestirim_pedestrian *tracker,
                                          float (*sigma)[3]);

// Length of the horizontal path walked so far, from stance to stance, m.
kestirim_status kestirim_pedestrian_path_length(const struct kestirim_pedestrian *tracker,
                                                float *length);

// Whether the path can be relied upon. Reasons why not: `NOT_OBSERVABLE` until the foot has stood still for half a
// second; `SATURATED` if a sensor's range is too small; `UNITS` if values seem to be in g or degrees instead of m/s²
// or rad, or the accelerometer needs calibration; `AXES` if axes are swapped between the two sensors; `DROPOUT` after
// gaps or if the tilt was lost; `INNOVATIONS` if strides end with too large a velocity or jump; `RANGE` if the path
// exceeds the range of the number format.
kestirim_status kestirim_pedestrian_health(const struct kestirim_pedestrian *tracker,
                                           struct kestirim_health *health);

// Stores the pedestrian tracker in a buffer, to be restored after a sleep or on another machine.
// `KESTIRIM_PEDESTRIAN_SNAPSHOT` bytes are enough; `length` receives the number of bytes used.
//
// Errors: `TOO_SMALL` for the buffer.
kestirim_status kestirim_pedestrian_snapshot(const struct kestirim_pedestrian *tracker,
                                             uint8_t *buffer,
                                             size_t capacity,
                                             size_t *length);

// Restores a pedestrian tracker from a snapshot that `kestirim_pedestrian_snapshot` stored, in memory of at least
// `kestirim_pedestrian_size()` bytes. It continues bit for bit as if there had been no interruption. `length` may
// exceed the snapshot, such as a whole page of flash.
//
// Errors: `NO_SNAPSHOT`; `FOREIGN_SNAPSHOT`; `DAMAGED_SNAPSHOT`.
kestirim_status kestirim_pedestrian_restore(void *memory,
                                            size_t size,
                                            const uint8_t *snapshot,
                                            size_t length,
                                            struct kestirim_pedestrian **tracker);

// Size of a tag tracker on this target, bytes.
size_t kestirim_robot_size(void);

// Alignment of the tag tracker's memory on this target, bytes.
size_t kestirim_robot_align(void);

// Creates a tag tracker without a position yet, in memory of at least `kestirim_robot_size()` bytes, for up to
// `KESTIRIM_MOST_ANCHORS` anchors. Ranges refer to an anchor by its index in this array.
//
// Errors: `TOO_MANY`; `NOT_FINITE`.
kestirim_status kestirim_robot_init(void *memory,
                                    size_t size,
                                    const struct kestirim_tag_config *config,
                                    const struct kestirim_anchor *anchors,
                                    size_t count,
                                    struct kestirim_robot **tracker);

// Processes a range to an anchor. `report` receives its outcome, and may be null.
//
// Errors: `NO_SUCH_ANCHOR`; `IMPLAUSIBLE` below -1 m or above 200 m; `DUPLICATE`; `OUT_OF_ORDER` if it is more than
// 0.1 s older than the estimate; `NOT_FINITE`.
kestirim_status kestirim_robot_range(struct kestirim_robot *tracker,
                                     const struct kestirim_range *sample,
                                     struct kestirim_range_report *report);

// Processes a sample of the tag's IMU, which shows whether the tag stands.
//
// Errors: `NOT_FINITE`; `IMPLAUSIBLE` beyond 500 m/s²; `OUT_OF_ORDER`.
kestirim_status kestirim_robot_inertial(struct kestirim_robot *tracker,
                                        const struct kestirim_inertial *sample);

// Processes a sample of the wheels: the speed, and whether the robot turns. `kestirim_wheels` makes fuller use of
// wheels.
//
// Errors: `NOT_FINITE`; `IMPLAUSIBLE` beyond 100 m/s or rad/s; `OUT_OF_ORDER`.
kestirim_status kestirim_robot_odometry(struct kestirim_robot *tracker,
                                        const struct kestirim_odometry *sample);

// Sets the height of the tag in the room frame, m.
//
// Errors: `NOT_FINITE`.
kestirim_status kestirim_robot_set_height(struct kestirim_robot *tracker, float height);

// Position of the tag, m, room frame: x, y.
//
// Errors: `NO_ESTIMATE` before the first position, or while it is lost.
kestirim_status kestirim_robot_position(const struct kestirim_robot *tracker, float (*position)[2]);

// Velocity of the tag, m/s, room frame: x, y.
//
// Errors: `NO_ESTIMATE`.
kestirim_status kestirim_robot_velocity(const struct kestirim_robot *tracker, float (*velocity)[2]);

// Standard deviation of the tag's position at a time (µs), m: the root of the sum of both axes' variances, including
// the effect of the anchors' constant errors and of a second position that the ranges allow.
//
// Errors: `NO_ESTIMATE`.
kestirim_status kestirim_robot_sigma(const struct kestirim_robot *tracker,
                                     uint64_t time_us,
                                     float *sigma);

// Whether the tag's position can be relied upon at a time (µs). `details` receives the health in numbers, and may be
// null.
kestirim_status kestirim_robot_health(const struct kestirim_robot *tracker,
                                      uint64_t time_us,
                                      struct kestirim_health *health,
                                      struct kestirim_tag_health *details);

// Stores the tag tracker in a buffer, to be restored after a sleep or on another machine. `KESTIRIM_ROBOT_SNAPSHOT`
// bytes are enough; `length` receives the number of bytes used.
//
// Errors: `TOO_SMALL` for the buffer.
kestirim_status kestirim_robot_snapshot(const struct kestirim_robot *tracker,
                                        uint8_t *buffer,
                                        size_t capacity,
                                        size_t *length);

// Restores a tag tracker from a snapshot that `kestirim_robot_snapshot` stored, in memory of at least
// `kestirim_robot_size()` bytes. It continues bit for bit as if there had been no interruption. `length` may exceed
// the snapshot, such as a whole page of flash.
//
// Errors: `NO_SNAPSHOT`; `FOREIGN_SNAPSHOT`; `DAMAGED_SNAPSHOT`.
kestirim_status kestirim_robot_restore(void *memory,
                                       size_t size,
                                       const uint8_t *snapshot,
                                       size_t length,
                                       struct kestirim_robot **tracker);

// The meaning of a status in plain English, as a string with static lifetime; "unknown status" for a number that is
// not a status.
const char *kestirim_status_name(int32_t status);

// Size of a flight filter on this target, bytes.
size_t kestirim_uav_size(void);

// Alignment of the flight filter's memory on this target, bytes.
size_t kestirim_uav_align(void);

// Writes an example model: the Aerosonde, a small unmanned aircraft, with a pitch gyroscope, a Pitot tube and an
// attitude reference at 100 Hz. Its outputs are pitch rate (rad/s), airspeed (m/s) and pitch angle (rad).
kestirim_status kestirim_uav_aerosonde(struct kestirim_uav_model *model);

// Creates a flight filter of a model, with an unknown state, in memory of at least `kestirim_uav_size()` bytes.
//
// Errors: `NOT_FINITE`; `INVALID_ARGUMENT` if the usual interval is not positive.
kestirim_status kestirim_uav_init(void *memory,
                                  size_t size,
                                  const struct kestirim_uav_model *model,
                                  struct kestirim_uav **filter);

// Processes a sample of a flight. If it is more than a second older than the preceding one, the clock was set back,
// and the filter restarts.
//
// Errors: `OUT_OF_ORDER`; `GAP` of more than a million usual intervals; `NOT_FINITE`.
kestirim_status kestirim_uav_update(struct kestirim_uav *filter,
                                    const struct kestirim_uav_sample *sample);

// Estimate of the aircraft's state at the time of the last sample: angle of attack (rad), pitch rate (rad/s), airspeed
// (m/s), pitch angle (rad), as deviations from the model's steady flight.
kestirim_status kestirim_uav_estimate(const struct kestirim_uav *filter,
                                      double (*estimate)[4]);

// Standard deviations of the aircraft's estimated state: angle of attack (rad), pitch rate (rad/s), airspeed (m/s),
// pitch angle (rad).
kestirim_status kestirim_uav_sigma(const struct kestirim_uav *filter,
                                   double (*sigma)[4]);

// Whether the estimate of the flight can be relied upon. Reasons why not: `INNOVATIONS` if measurements and model have
// contradicted each other over about 200 samples; `REJECTED` if over about 50 samples more than a tenth of the
// measurements were rejected; `TIME` if over about 1000 samples outputs or inputs seem to be late.
kestirim_status kestirim_uav_health(const struct kestirim_uav *filter,
                                    struct kestirim_health *health);

// Stores the flight filter in a buffer, to be restored after a sleep or on another machine. `KESTIRIM_UAV_SNAPSHOT`
// bytes are enough; `length` receives the number of bytes used.
//
// Errors: `TOO_SMALL` for the buffer.
kestirim_status kestirim_uav_snapshot(const struct kestirim_uav *filter,
                                      uint8_t *buffer,
                                      size_t capacity,
                                      size_t *length);

// Restores a flight filter from a snapshot that `kestirim_uav_snapshot` stored, in memory of at least
// `kestirim_uav_size()` bytes. It continues bit for bit as if there had been no interruption. `length` may exceed
// the snapshot, such as a whole page of flash.
//
// Errors: `NO_SNAPSHOT`; `FOREIGN_SNAPSHOT`; `DAMAGED_SNAPSHOT`.
kestirim_status kestirim_uav_restore(void *memory,
                                     size_t size,
                                     const uint8_t *snapshot,
                                     size_t length,
                                     struct kestirim_uav **filter);

// Size of a wheel tracker on this target, bytes.
size_t kestirim_wheels_size(void);

// Alignment of the wheel tracker's memory on this target, bytes.
size_t kestirim_wheels_align(void);

// Creates a wheel tracker without a position yet, in memory of at least `kestirim_wheels_size()` bytes, for up to
// `KESTIRIM_MOST_ANCHORS` anchors. Ranges refer to an anchor by its index in this array.
//
// Errors: `TOO_MANY`; `NOT_FINITE`.
kestirim_status kestirim_wheels_init(void *memory,
                                     size_t size,
                                     const struct kestirim_tag_config *config,
                                     const struct kestirim_anchor *anchors,
                                     size_t count,
                                     struct kestirim_wheels **tracker);

// Processes a range to an anchor. `report` receives its outcome, and may be null.
//
// Errors: `NO_SUCH_ANCHOR`; `IMPLAUSIBLE` below -1 m or above 200 m; `DUPLICATE`; `OUT_OF_ORDER` if it is more than
// 0.1 s older than the estimate; `NOT_FINITE`.
kestirim_status kestirim_wheels_range(struct kestirim_wheels *tracker,
                                      const struct kestirim_range *sample,
                                      struct kestirim_range_report *report);

// Processes a sample of the wheels: their motion since the preceding sample. Pass every sample, in the order of time
// with the ranges.
//
// Errors: `NOT_FINITE`; `IMPLAUSIBLE` beyond 100 m/s or rad/s; `OUT_OF_ORDER`.
kestirim_status kestirim_wheels_odometry(struct kestirim_wheels *tracker,
                                         const struct kestirim_odometry *sample);

// Sets the height of the tag in the room frame, m.
//
// Errors: `NOT_FINITE`.
kestirim_status kestirim_wheels_set_height(struct kestirim_wheels *tracker, float height);

// Position of the tag, m, room frame: x, y.
//
// Errors: `NO_ESTIMATE` before the first position, or while it is lost.
kestirim_status kestirim_wheels_position(const struct kestirim_wheels *tracker,
                                         float (*position)[2]);

// Standard deviation of the tag's position at a time (µs), m: the root of the sum of both axes' variances, including
// the effect of the anchors' constant errors.
//
// Errors: `NO_ESTIMATE`.
kestirim_status kestirim_wheels_sigma(const struct kestirim_wheels *tracker,
                                      uint64_t time_us,
                                      float *sigma);

// Whether the tag's position can be relied upon at a time (µs). `details` receives the health in numbers, and may be
// null.
kestirim_status kestirim_wheels_health(const struct kestirim_wheels *tracker,
                                       uint64_t time_us,
                                       struct kestirim_health *health,
                                       struct kestirim_tag_health *details);

// Factor by which distances measured by the wheels have to be multiplied.
//
// Errors: `NO_ESTIMATE` before the factor is known.
kestirim_status kestirim_wheels_scale(const struct kestirim_wheels *tracker, float *scale);

// Stores the wheel tracker in a buffer, to be restored after a sleep or on another machine. `KESTIRIM_WHEELS_SNAPSHOT`
// bytes are enough; `length` receives the number of bytes used.
//
// Errors: `TOO_SMALL` for the buffer.
kestirim_status kestirim_wheels_snapshot(const struct kestirim_wheels *tracker,
                                         uint8_t *buffer,
                                         size_t capacity,
                                         size_t *length);

// Restores a wheel tracker from a snapshot that `kestirim_wheels_snapshot` stored, in memory of at least
// `kestirim_wheels_size()` bytes. It continues bit for bit as if there had been no interruption. `length` may exceed
// the snapshot, such as a whole page of flash.
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
