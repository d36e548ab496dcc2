//! Serialisation of [`Health`]: an object with words in human-readable formats, the bits in others.

use ::serde::de::{Deserialize, Deserializer, Error, SeqAccess, Visitor};
use ::serde::ser::{Serialize, SerializeStruct, Serializer};
use core::fmt;

use crate::Health;

impl Serialize for Health {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        if !serializer.is_human_readable() {
            return self.bits.serialize(serializer);
        }
        let mut object = serializer.serialize_struct("Health", 2)?;
        object.serialize_field("state", &self.state())?;
        object.serialize_field("reasons", &Reasons(*self))?;
        object.end()
    }
}

impl<'de> Deserialize<'de> for Health {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        if deserializer.is_human_readable() {
            return Object::deserialize(deserializer).map(|object| object.reasons.0);
        }
        // Reasons stored by a later version are refused, not partly read.
        Self::from_bits(u16::deserialize(deserializer)?)
            .ok_or_else(|| D::Error::custom("an unknown reason"))
    }
}

/// The human-readable form; the state follows from the reasons.
#[derive(::serde::Deserialize)]
struct Object {
    reasons: Reasons,
}

struct Reasons(Health);

impl Serialize for Reasons {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_seq(self.0.reasons())
    }
}

impl<'de> Deserialize<'de> for Reasons {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Words;
        impl<'de> Visitor<'de> for Words {
            type Value = Health;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("a list of reasons")
            }

            fn visit_seq<A: SeqAccess<'de>>(self, mut words: A) -> Result<Health, A::Error> {
                let mut health = Health::GOOD;
                while let Some(reason) = words.next_element()? {
                    health.add(reason);
                }
                Ok(health)
            }
        }
        deserializer.deserialize_seq(Words).map(Self)
    }
}
