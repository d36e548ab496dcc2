use crate::channel::Channel;
use crate::config::{Config, Motion};
use crate::start::code_position;
use crate::{Error, Sighting};
use heapless::Vec;
use kestirim_gnss_ppp::{
    Arc, Expected, GpsTime, Receiver, Site, Slip, ionosphere_free, ionosphere_free_phase,
};
use kestirim_kalman::{Covariance, Gaussian, SparseRow};
use nalgebra::{Matrix3, SVector, Vector3};

/// States besides the ambiguities: three coordinates, the receiver's clock, the wet zenith delay.
pub(crate) const COMMON: usize = 5;
pub(crate) const CLOCK: usize = 3;
pub(crate) const WET: usize = 4;

/// How many states a filter for so many satellites at a time has.
pub const fn states(satellites: usize) -> usize {
    COMMON + satellites
}

/// f
#[derive(Clone, Copy, Debug)]
pub struct PppFilter<const N: usize> {
    config: Config,
    running: Option<Running<N>>,
}

#[derive(Clone, Copy, Debug)]
struct Running<const N: usize> {
    estimate: Gaussian<f64, N>,
    time: GpsTime,
    channels: [Option<Channel>; N],
}

struct Line {
    index: usize,
    expected: Expected,
    code: f64,
    phase: f64,
    code_variance: f64,
    phase_variance: f64,
    slip: Option<Slip>,
}

#[derive(Clone, Copy, Debug)]
pub struct Solution {
    pub time: GpsTime,
    pub position: Vector3<f64>,
    pub covariance_enu: Matrix3<f64>,
    pub used: usize, pub rejected: usize,
    pub slips: usize,
}

impl<const N: usize> PppFilter<N> {
    pub const fn new(config: Config) -> Self {
        Self { config, running: None }
    }

    pub fn process(
        &mut self,
        time: GpsTime,
        receiver: &Receiver<'_>,
        sightings: &[Sighting<'_>],
    ) -> Result<Solution, Error> {
        let mut next = match self.running {
            Some(mut running) => {
                running.advance(time, &self.config)?;
                running
            }
            None => Running::start(time, sightings, &self.config)?,
        };
        let solution = next.observe(receiver, sightings, &self.config)?;
        self.running = Some(next);
        Ok(solution)
    }
}

impl<const N: usize> Running<N> {
    fn start(time: GpsTime, sightings: &[Sighting<'_>], config: &Config) -> Result<Self, Error> {
        let start = code_position(sightings)?;
        let mut mean = SVector::<f64, N>::zeros();
        mean.fixed_rows_mut::<3>(0).copy_from(&start.position);
        mean[CLOCK] = start.clock;
        mean[WET] = 0.1;
        let mut variances = [0.0; N];
        variances[..3].fill(1e4);
        variances[CLOCK] = 1e6;
        variances[WET] = config.wet_delay * config.wet_delay;
        Ok(Self {
            estimate: Gaussian::new(mean, Covariance::from_variances(&variances)),
            time,
            channels: [None; N],
        })
    }

    fn advance(&mut self, time: GpsTime, config: &Config) -> Result<(), Error> {
        let elapsed = time.since(self.time);
        if !(elapsed > 0.0) {
            return Err(Error::TimeNotAdvancing);
        }
        self.time = time;
        let mut add = |index: usize, rate: f64| {
            self.estimate.add_variance_at(index, rate * elapsed).map_err(|_| Error::NotFinite)
        };
        if let Motion::Kinematic { process_noise } = config.motion {
            for index in 0..3 {
                add(index, process_noise)?;
            }
        }
        add(WET, config.wet_delay_walk)
    }

    fn observe(
        &mut self,
        receiver: &Receiver<'_>,
        sightings: &[Sighting<'_>],
        config: &Config,
    ) -> Result<Solution, Error> {
        let position = self.estimate.mean.fixed_rows::<3>(0).into_owned();
        let site = Site::new(receiver, &position, self.time);
        let lines = self.lines(&site, sightings, config)?;
        if lines.len() < 4 {
            return Err(Error::TooFewSatellites);
        }
        let clock = median(lines.iter().map(|line| line.code));
        self.estimate.reset_at(CLOCK, clock, 1e6).map_err(|_| Error::NotFinite)?;
        for line in &lines {
            if line.slip.is_some() {
                let ambiguity = line.phase - line.code;
                self.estimate.reset_at(line.index, ambiguity, 1e4).map_err(|_| Error::NotFinite)?;
            }
        }
        let prior = self.estimate;
        let mut rows: Vec<([(usize, f64); 6], f64, f64, f64, bool), 64> = Vec::new();
        for line in &lines {
            let s = line.expected.sight;
            let w = line.expected.wet_mapping;
            let row = |a: f64| [(0, -s.x), (1, -s.y), (2, -s.z), (CLOCK, 1.0), (WET, w), (line.index, a)];
            let _ = rows.push((row(0.0), line.code, line.code_variance, 1.0, false));
            let _ = rows.push((row(1.0), line.phase, line.phase_variance, 1.0, false));
        }
        let innovation = |row: &[(usize, f64); 6], value: f64, mean: &SVector<f64, N>| {
            let shift = mean.fixed_rows::<3>(0) - prior.mean.fixed_rows::<3>(0);
            let mut computed = mean[CLOCK] + row[4].1 * mean[WET] + row[5].1 * mean[row[5].0];
            for k in 0..3 { computed += row[k].1 * shift[k]; }
            value - computed
        };
        let k0 = config.k0; let k1 = config.k1;
        for _ in 0..20 {
            self.estimate = prior;
            for (row, value, variance, weight, _) in &rows {
                if *weight < 1e-6 { continue; }
                let nu = innovation(row, *value, &self.estimate.mean);
                self.estimate.update(&SparseRow::new(*row), nu, variance / weight).map_err(|_| Error::NotFinite)?;
            }
            if k0 <= 0.0 { break; }
            let mut worst = (0.0, usize::MAX);
            for (n, (row, value, variance, weight, done)) in rows.iter().enumerate() {
                if *done { continue; }
                let v = innovation(row, *value, &self.estimate.mean);
                let mut hph = 0.0;
                for a in row { for b in row { hph += a.1 * b.1 * self.estimate.covariance.get(a.0, b.0).unwrap_or(0.0); } }
                let q = variance / weight - hph;
                if q < 0.01 * variance { continue; }
                let t = (v * v / q).sqrt();
                if t > worst.0 { worst = (t, n); }
            }
            if worst.0 <= k0 { break; }
            let t = worst.0;
            let g = if t > k1 { 0.0 } else { k0 / t * ((k1 - t) / (k1 - k0)).powi(2) };
            rows[worst.1].3 = g; rows[worst.1].4 = true;
        }
        let mut rejected = 0;
        for (n, line) in lines.iter().enumerate() {
            if let Some(channel) = self.channels[line.index].as_mut() {
                if rows[2 * n + 1].3 < 0.1 { channel.bad += 1; rejected += 1; } else { channel.bad = 0; }
            }
        }
        let p = self.estimate.covariance.to_matrix().fixed_view::<3, 3>(0, 0).into_owned();
        let rotation = site.enu_from_ecef();
        Ok(Solution {
            time: self.time,
            position: self.estimate.mean.fixed_rows::<3>(0).into_owned(),
            covariance_enu: rotation * p * rotation.transpose(),
            used: lines.len(), rejected,
            slips: lines.iter().filter(|line| line.slip.is_some()).count(),
        })
    }

    fn lines(
        &mut self,
        site: &Site<'_>,
        sightings: &[Sighting<'_>],
        config: &Config,
    ) -> Result<Vec<Line, N>, Error> {
        let mut lines = Vec::new();
        for sighting in sightings {
            let known = self.find(sighting.satellite);
            let previous = known.and_then(|index| self.channels[index].map(|channel| channel.wind_up));
            let Some(expected) = site.expect(&sighting.state, sighting.antenna.as_ref(), previous) else {
                continue;
            };
            if !(expected.direction.elevation >= config.elevation_mask) {
                continue;
            }
            let (index, slip) = match known {
                Some(index) => {
                    let channel = self.channels[index].as_mut().ok_or(Error::NotFinite)?;
                    channel.wind_up = expected.wind_up_cycles;
                    let slip = channel.arc.observe(self.time, sighting.phase, sighting.code, sighting.lock_lost, &config.slips);
                    let slip = if channel.bad >= config.patience { channel.bad = 0; slip.or(Some(Slip::LossOfLock)) } else { slip };
                    (index, slip)
                }
                None => {
                    let Some(index) = self.free() else { continue };
                    self.channels[index] = Some(Channel {
                        satellite: sighting.satellite,
                        arc: Arc::begin(self.time, sighting.phase, sighting.code),
                        wind_up: expected.wind_up_cycles, bad: 0,
                    });
                    (index, Some(Slip::Gap))
                }
            };
            let sine = libm::sin(expected.direction.elevation);
            let (interval, near) = (sighting.state.clock_interval, sighting.state.clock_distance);
            let bridge = if interval > 0.0 { config.clock_walk * near * (interval - near) / interval } else { 0.0 };
            let line = Line {
                index,
                code: ionosphere_free(sighting.code) - expected.range,
                phase: ionosphere_free_phase(sighting.phase) - expected.range - expected.wind_up,
                expected,
                code_variance: config.code.variance(sine) + bridge,
                phase_variance: config.phase.variance(sine) + bridge,
                slip,
            };
            if lines.push(line).is_err() { break; }
        }
        Ok(lines)
    }

    fn find(&self, satellite: u8) -> Option<usize> {
        self.channels.iter().position(|channel| channel.is_some_and(|channel| channel.satellite == satellite))
    }

    fn free(&self) -> Option<usize> {
        let free = (COMMON..N).find(|&index| self.channels[index].is_none());
        free.or_else(|| {
            (COMMON..N)
                .filter_map(|index| Some((index, self.time.since(self.channels[index]?.arc.last()))))
                .filter(|&(_, since)| since > 0.0)
                .max_by(|a, b| a.1.total_cmp(&b.1))
                .map(|(index, _)| index)
        })
    }
}

fn median(values: impl Iterator<Item = f64>) -> f64 {
    let mut sorted = Vec::<f64, 64>::from_iter(values.take(64));
    sorted.sort_unstable_by(f64::total_cmp);
    sorted.get(sorted.len() / 2).copied().unwrap_or(0.0)
}
