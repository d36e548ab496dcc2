//! Check that all floats of a value are finite, by a format that stores nothing and stops at the first that is not.

use core::fmt;

use serde::Serialize;
use serde::ser::{
    SerializeMap, SerializeSeq, SerializeStruct, SerializeStructVariant, SerializeTuple,
    SerializeTupleStruct, SerializeTupleVariant, Serializer,
};

/// Whether all floats are finite, or −∞ if `or_never` allows it.
pub(crate) fn is_finite(value: &impl Serialize, or_never: bool) -> bool {
    value.serialize(Finite { or_never }).is_ok()
}

/// Error for a float that is not finite.
#[derive(Debug)]
struct NotFinite;

impl fmt::Display for NotFinite {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str("not finite")
    }
}

impl core::error::Error for NotFinite {}

impl serde::ser::Error for NotFinite {
    fn custom<M: fmt::Display>(_: M) -> Self {
        Self
    }
}

#[derive(Clone, Copy)]
struct Finite {
    /// Whether −∞ is allowed, as the logarithm of a probability of zero.
    or_never: bool,
}

type Checked = Result<(), NotFinite>;

/// Accepts values without floats.
macro_rules! passed {
    ($($method:ident($($argument:ty),*);)*) => {
        $(fn $method(self $(, _: $argument)*) -> Checked { Ok(()) })*
    };
}

/// Starts a compound value, whose elements are checked by the same serializer.
macro_rules! begun {
    ($($method:ident($($argument:ty),*);)*) => {
        $(fn $method(self $(, _: $argument)*) -> Result<Self, NotFinite> { Ok(self) })*
    };
}

impl Serializer for Finite {
    type Ok = ();
    type Error = NotFinite;
    type SerializeSeq = Self;
    type SerializeTuple = Self;
    type SerializeTupleStruct = Self;
    type SerializeTupleVariant = Self;
    type SerializeMap = Self;
    type SerializeStruct = Self;
    type SerializeStructVariant = Self;

    passed! {
        serialize_bool(bool);
        serialize_i8(i8);
        serialize_i16(i16);
        serialize_i32(i32);
        serialize_i64(i64);
        serialize_i128(i128);
        serialize_u8(u8);
        serialize_u16(u16);
        serialize_u32(u32);
        serialize_u64(u64);
        serialize_u128(u128);
        serialize_char(char);
        serialize_str(&str);
        serialize_bytes(&[u8]);
        serialize_none();
        serialize_unit();
        serialize_unit_struct(&'static str);
        serialize_unit_variant(&'static str, u32, &'static str);
    }

    begun! {
        serialize_seq(Option<usize>);
        serialize_tuple(usize);
        serialize_tuple_struct(&'static str, usize);
        serialize_tuple_variant(&'static str, u32, &'static str, usize);
        serialize_map(Option<usize>);
        serialize_struct(&'static str, usize);
        serialize_struct_variant(&'static str, u32, &'static str, usize);
    }

    fn serialize_f32(self, value: f32) -> Checked {
        let never = self.or_never && value == f32::NEG_INFINITY;
        if value.is_finite() || never { Ok(()) } else { Err(NotFinite) }
    }

    fn serialize_f64(self, value: f64) -> Checked {
        let never = self.or_never && value == f64::NEG_INFINITY;
        if value.is_finite() || never { Ok(()) } else { Err(NotFinite) }
    }

    fn serialize_some<V: Serialize + ?Sized>(self, value: &V) -> Checked {
        value.serialize(self)
    }

    fn serialize_newtype_struct<V: Serialize + ?Sized>(
        self,
        _: &'static str,
        value: &V,
    ) -> Checked {
        value.serialize(self)
    }

    fn serialize_newtype_variant<V: Serialize + ?Sized>(
        self,
        _: &'static str,
        _: u32,
        _: &'static str,
        value: &V,
    ) -> Checked {
        value.serialize(self)
    }

    fn collect_str<V: fmt::Display + ?Sized>(self, _: &V) -> Checked {
        Ok(())
    }

    fn is_human_readable(&self) -> bool {
        false
    }
}

/// Checks the elements of a collection one by one.
macro_rules! collection {
    ($($trait:ident::$method:ident($($key:ty),*);)*) => {
        $(impl $trait for Finite {
            type Ok = ();
            type Error = NotFinite;

            fn $method<V: Serialize + ?Sized>(&mut self $(, _: $key)*, value: &V) -> Checked {
                value.serialize(*self)
            }

            fn end(self) -> Checked {
                Ok(())
            }
        })*
    };
}

collection! {
    SerializeSeq::serialize_element();
    SerializeTuple::serialize_element();
    SerializeTupleStruct::serialize_field();
    SerializeTupleVariant::serialize_field();
    SerializeStruct::serialize_field(&'static str);
    SerializeStructVariant::serialize_field(&'static str);
}

impl SerializeMap for Finite {
    type Ok = ();
    type Error = NotFinite;

    fn serialize_key<V: Serialize + ?Sized>(&mut self, key: &V) -> Checked {
        key.serialize(*self)
    }

    fn serialize_value<V: Serialize + ?Sized>(&mut self, value: &V) -> Checked {
        value.serialize(*self)
    }

    fn end(self) -> Checked {
        Ok(())
    }
}
