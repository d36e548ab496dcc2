//! Forward and backward passes combined: the positions of a receiver given the observations before and after.

use kestirim_gnss_ppp::Geodetic;
use kestirim_ppp_filter::{Contradiction, Health};
use nalgebra::Vector3;

use super::followed::{Fix, Followed};

/// Times closer together than this are the same, s.
const SAME: f64 = 1e-3;
/// The distance between both directions, in standard deviations of the difference, beyond which they are wrong by
/// something that neither knows of. Filters of clean days stay below three.
const APART: f64 = 5.0;

impl Followed {
    /// Combines a forward pass (`self`) with a `backwards` one: the mean of both positions, to the east, north and up,
    /// weighted by the inverse of their variances (Fraser and Potter 1969). An epoch that is contradicted in one of
    /// them is taken from the other, and so is one that only one has.
    ///
    /// Both used the epoch itself, so its noise is in both, and the mean is reported to be no better than the better of
    /// them. Where they are further apart than their variances allow, as for a receiver that is taken to rest and was
    /// moved, the position is contradicted, and its standard deviation is the distance between them.
    #[must_use]
    pub fn smoothed(&self, backwards: &Self) -> Self {
        let mut both = Self { epochs: self.epochs, ..Self::default() };
        let (mut ours, mut theirs) = (0, 0);
        loop {
            let times =
                [self.fixes.get(ours), backwards.fixes.get(theirs)].map(|it| it.map(|it| it.t));
            let [is_ours, is_theirs] = match times {
                [None, None] => break,
                [Some(_), None] => [true, false],
                [None, Some(_)] => [false, true],
                [Some(forth), Some(back)] => [forth <= back + SAME, back <= forth + SAME],
            };
            match [is_ours, is_theirs] {
                [true, true] => both.take_mean([(self, ours), (backwards, theirs)]),
                [true, false] => both.take_one(self, ours),
                _ => both.take_one(backwards, theirs),
            }
            ours += usize::from(is_ours);
            theirs += usize::from(is_theirs);
        }
        both.last = self.last;
        both.fixing = self.fixing;
        both
    }

    fn take_one(&mut self, other: &Self, index: usize) {
        self.fixes.push(other.fixes[index]);
        self.deviations.push(other.deviations[index]);
        self.delays.push(other.delays[index]);
        self.healths.push(other.healths[index]);
        self.heard.push(other.heard[index]);
    }

    fn take_mean(&mut self, pair: [(&Self, usize); 2]) {
        let is_contradicted = |(followed, index): &(&Self, usize)| {
            matches!(followed.healths[*index], Health::Contradicted(_))
        };
        match pair.map(|one| is_contradicted(&one)) {
            [true, false] => return self.take_one(pair[1].0, pair[1].1),
            [false, true] => return self.take_one(pair[0].0, pair[0].1),
            _ => {}
        }
        let [(ours, at), (theirs, there)] = pair;
        let Fix { t, position } = ours.fixes[at];
        let rotation = Geodetic::from_ecef(&position).enu_from_ecef();
        let apart = rotation * (theirs.fixes[there].position - position);
        let [forth, back] = [ours.deviations[at], theirs.deviations[there]];
        // The weight of the other direction on each axis.
        let share = |axis: usize| forth[axis].powi(2) / (forth[axis].powi(2) + back[axis].powi(2));
        let moved = Vector3::from_fn(|axis, _| share(axis) * apart[axis]);
        self.take_one(ours, at);
        let last = self.fixes.len() - 1;
        self.fixes[last] = Fix { t, position: position + rotation.transpose() * moved };
        self.deviations[last] = [0, 1, 2].map(|axis| forth[axis].min(back[axis]));
        let healths = [ours.healths[at], theirs.healths[there]];
        self.healths[last] =
            if healths.contains(&Health::Converged) { Health::Converged } else { healths[0] };
        let disagree = |axis: usize| apart[axis].abs() > APART * forth[axis].hypot(back[axis]);
        if (0..3).any(disagree) {
            self.apart.push(t);
            self.healths[last] = Health::Contradicted(Contradiction::Motion);
        }
        for axis in (0..3).filter(|axis| disagree(*axis)) {
            self.deviations[last][axis] = apart[axis].abs();
        }
    }
}

#[cfg(test)]
mod tests {
    use kestirim_ppp_filter::Contradiction;

    use super::*;

    /// At the equator, where up is x, east y and north z.
    const PLACE: Vector3<f64> = Vector3::new(6_378_137.0, 0.0, 0.0);

    /// Positions at the given height above `PLACE`, with its standard deviation, at each time.
    fn followed(fixes: &[(f64, f64, f64, Health)]) -> Followed {
        let mut followed = Followed::default();
        for &(t, up, sigma, health) in fixes {
            followed.fixes.push(Fix { t, position: PLACE + Vector3::x() * up });
            followed.deviations.push([1.0, 1.0, sigma]);
            followed.delays.push([0.0; 2]);
            followed.healths.push(health);
            followed.heard.push(8);
        }
        followed
    }

    #[test]
    fn the_better_known_counts_more_and_what_is_contradicted_nothing() {
        const WRONG: Health = Health::Contradicted(Contradiction::Motion);
        let forwards = followed(&[
            (0.0, 3.0, 2.0, Health::Converging),
            (30.0, 1.0, 0.1, Health::Converged),
            (60.0, 9.0, 0.1, WRONG),
        ]);
        let backwards = followed(&[
            (0.0, 1.0, 1.0, Health::Converged),
            (60.0, 2.0, 0.2, Health::Converged),
            (90.0, 5.0, 3.0, Health::Converging),
        ]);
        let both = forwards.smoothed(&backwards);
        let times: Vec<_> = both.fixes.iter().map(|fix| fix.t).collect();
        assert_eq!(times, [0.0, 30.0, 60.0, 90.0]);
        let ups = both.fixes.iter().map(|fix| fix.position.x - PLACE.x);
        for (up, expected) in ups.zip([1.4, 1.0, 2.0, 5.0]) {
            assert!((up - expected).abs() < 1e-6, "{up} {expected}");
        }
        let sigmas: Vec<_> = both.deviations.iter().map(|it| it[2]).collect();
        assert_eq!(sigmas, [1.0, 0.1, 0.2, 3.0]);
        let expected =
            [Health::Converged, Health::Converged, Health::Converged, Health::Converging];
        assert_eq!(both.healths, expected);
        assert!(Followed::default().smoothed(&Followed::default()).fixes.is_empty());
    }

    #[test]
    fn two_directions_that_disagree_contradict_each_other() {
        let forwards = [(0.0, 0.3, 0.01, Health::Converged), (30.0, 0.02, 0.01, Health::Converged)];
        let backwards = [0.0, 30.0].map(|t| (t, 0.0, 0.01, Health::Converged));
        let both = followed(&forwards).smoothed(&followed(&backwards));
        assert_eq!(both.healths, [Health::Contradicted(Contradiction::Motion), Health::Converged]);
        let sigmas: Vec<_> = both.deviations.iter().map(|it| it[2]).collect();
        assert!((sigmas[0] - 0.3).abs() < 1e-9 && sigmas[1] == 0.01, "{sigmas:?}");
    }
}
