//! Which class a sensor is of.

use kestirim_pedestrian::SensorClass;

use super::evidence;
use crate::systems::pedestrian::recording::Recording;

/// The class of a recording's sensor, looked for once; that of bare chips if it never stood still. Truth is not asked.
pub(in crate::systems::pedestrian) fn class_of(recording: &Recording) -> SensorClass {
    let found = || evidence::class(&recording.log.samples, recording.measured());
    *recording.class.get_or_init(found)
}
