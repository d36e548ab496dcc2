//! The true positions of the users of a recorded flight.

use std::path::Path;

use super::plane::{Origin, Places};
use crate::Error;
use crate::table;

/// The true positions: one for each user, or a user's track if times are given.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Truth {
    known: Vec<Known>,
}

/// A line of the file.
#[derive(Debug, Clone, PartialEq)]
struct Known {
    /// The time (s); `None` for a stationary user.
    t: Option<f64>,
    place: [f64; 2],
    user: Option<String>,
}

impl Truth {
    /// Reads columns x,y, or lat,lon if the log has these; for a moving user also t, and for several users also the
    /// column user.
    ///
    /// # Errors
    /// An error that names the file, the line, and what was expected there.
    pub fn read(path: &Path, mut origin: Option<Origin>) -> Result<Self, Error> {
        let mut known: Vec<Known> = Vec::new();
        table::read(
            path,
            "the user's place",
            move |header| {
                let places = Places::find(header)?.as_in_log(header, origin)?;
                Ok((places, header.find("t")?, header.find("user")?))
            },
            |(places, t, user), row| {
                let t = t.map(|t| row.time_us(t)).transpose()?.map(|t| t as f64 * 1e-6);
                let user = user.map(|user| row.text(user).trim().to_owned());
                let before = known.iter().rev().find(|it| it.user == user);
                if let Some(before) = before {
                    if t.is_none() {
                        return Err(row.line.error("expected one place, found a second one"));
                    }
                    if t <= before.t {
                        return Err(row
                            .line
                            .error("expected a later time than in the line before"));
                    }
                }
                known.push(Known { t, place: places.read(row, &mut origin)?, user });
                Ok(())
            },
        )?;
        Ok(Self { known })
    }

    /// The true position of a user at a time (s), interpolated linearly between lines and constant before the first and
    /// after the last. Lines without a user name apply to any user.
    pub fn of(&self, user: Option<&str>, t: f64) -> Option<[f64; 2]> {
        let is_of = |known: &&Known| {
            let Some(name) = &known.user else { return true };
            user.is_none_or(|user| user == name)
        };
        let (mut before, mut after): (Option<&Known>, Option<&Known>) = (None, None);
        for known in self.known.iter().filter(is_of) {
            if known.t.is_none_or(|time| time <= t) {
                before = Some(known);
            } else if after.is_none() {
                after = Some(known);
            }
        }
        let (Some(first), Some(second)) = (before, after) else {
            return before.or(after).map(|known| known.place);
        };
        let (begin, end) = (first.t?, second.t?);
        let share = (t - begin) / (end - begin);
        let between =
            |axis: usize| first.place[axis] + share * (second.place[axis] - first.place[axis]);
        Some([between(0), between(1)])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(text: &str) -> Result<Truth, String> {
        let file = tempfile::NamedTempFile::new().unwrap();
        std::fs::write(file.path(), text).unwrap();
        let read = Truth::read(file.path(), None);
        read.map_err(|error| error.to_string().replace(&file.path().display().to_string(), "file"))
    }

    #[test]
    fn one_place_a_track_and_several_users_are_read() {
        let one = read("x,y\n3,4\n").unwrap();
        assert_eq!(one.of(None, 7.0), Some([3.0, 4.0]));
        assert_eq!(one.of(Some("a"), 7.0), Some([3.0, 4.0]));
        let track = read("t,x,y\n10,0,0\n20,10,-20\n").unwrap();
        assert_eq!(track.of(None, 0.0), Some([0.0, 0.0]));
        assert_eq!(track.of(None, 15.0), Some([5.0, -10.0]));
        assert_eq!(track.of(None, 99.0), Some([10.0, -20.0]));
        let several = read("user,x,y\na,1,2\nb,3,4\n").unwrap();
        assert_eq!(several.of(Some("b"), 0.0), Some([3.0, 4.0]));
        assert_eq!(several.of(Some("c"), 0.0), None);
    }

    #[test]
    fn a_second_place_needs_a_later_time() {
        let refused = |text: &str| read(text).unwrap_err();
        assert!(refused("x,y\n3,4\n3,4\n").contains("expected one place, found a second one"));
        assert!(refused("t,x,y\n2,3,4\n2,3,5\n").contains("expected a later time"));
    }
}
