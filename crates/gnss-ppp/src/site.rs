use crate::{
    Bodies, Correction, Corrections, Geodetic, GpsTime, OceanLoading, Pattern, Troposphere,
    pole_tide, solid_tide,
};
use nalgebra::{Matrix3, Vector3};

/// The properties of a receiver besides its position.
#[derive(Clone, Copy, Debug, Default)]
pub struct Receiver<'a> {
    /// The antenna on L1 and L2 of GPS, where known.
    pub antenna: Option<[Pattern<'a>; 2]>,
    /// The antenna on the two observed carriers of Galileo, where known.
    pub galileo_antenna: Option<[Pattern<'a>; 2]>,
    /// The antenna on the two carriers of GLONASS, where known.
    pub glonass_antenna: Option<[Pattern<'a>; 2]>,
    /// The antenna on the two observed carriers of BeiDou, where known.
    pub beidou_antenna: Option<[Pattern<'a>; 2]>,
    /// The offset from the marker to the antenna's reference point: east, north, up, m.
    pub eccentricity: [f64; 3],
    /// The ocean loading of the station, where known.
    pub ocean_loading: Option<&'a OceanLoading>,
    /// The position of the pole, as for [`pole_tide`](crate::pole_tide()), rad, where known.
    pub pole: Option<[f64; 2]>,
    /// UT1 (or UTC) minus GPS time, s: the leap seconds since 1980, negated.
    pub ut1_minus_gps: f64,
    /// The corrections that are applied.
    pub corrections: Corrections,
}

/// A receiver's site at one epoch: everything that its satellites have in common.
#[derive(Clone, Copy, Debug)]
pub struct Site<'a> {
    pub(crate) receiver: Receiver<'a>,
    pub(crate) bodies: Bodies,
    pub(crate) enu_from_ecef: Matrix3<f64>,
    /// The position of the antenna's reference point, with the tides, ECEF, m.
    pub(crate) antenna: Vector3<f64>,
    pub(crate) troposphere: Troposphere,
}

impl<'a> Site<'a> {
    /// The site of a marker at `position` (ECEF, m, free of tides).
    pub fn new(receiver: &Receiver<'a>, position: &Vector3<f64>, time: GpsTime) -> Self {
        let bodies = Bodies::at(time, receiver.ut1_minus_gps);
        let place = Geodetic::from_ecef(position);
        let enu_from_ecef = place.enu_from_ecef();
        let mut local = Vector3::from(receiver.eccentricity);
        let corrections = receiver.corrections;
        if let Some(ocean) = receiver.ocean_loading
            && corrections.has(Correction::OceanLoading)
        {
            local += ocean.displacement(time, receiver.ut1_minus_gps);
        }
        let mut antenna = position + enu_from_ecef.transpose() * local;
        if corrections.has(Correction::SolidTide) {
            antenna += solid_tide(position, &bodies, time, receiver.ut1_minus_gps);
        }
        if let Some(pole) = receiver.pole
            && corrections.has(Correction::PoleTide)
        {
            antenna += pole_tide(position, pole, time);
        }
        Self {
            receiver: *receiver,
            bodies,
            enu_from_ecef,
            antenna,
            troposphere: Troposphere::over(&place, time),
        }
    }

    /// The rotation from ECEF to east, north, up.
    pub const fn enu_from_ecef(&self) -> &Matrix3<f64> {
        &self.enu_from_ecef
    }
}
