//! The layout of a value: a serialisation format that writes names and types of fields instead of their contents.

use std::collections::BTreeMap;
use std::fmt::Display;

use serde::Serialize;
use serde::ser::{self, Error as _, Serializer};

/// The unknown type of an option without a value.
const UNKNOWN: &str = "?";

/// The types that a value consists of, by name: their fields, or the variants that occurred.
pub(super) type Types = BTreeMap<String, String>;

/// The type of a value, and all types in it.
pub(super) fn of(value: &impl Serialize) -> (String, Types) {
    let mut types = Types::new();
    let name = value.serialize(Shape(&mut types)).expect("a shape");
    (name, types)
}

/// Combines what several values of a type reveal about it.
fn learn(types: &mut Types, name: &str, fields: String) -> String {
    let known = types.entry(name.to_owned()).or_insert_with(|| fields.clone());
    if known.matches(UNKNOWN).count() > fields.matches(UNKNOWN).count() {
        *known = fields;
    }
    name.to_owned()
}

struct Shape<'a>(&'a mut Types);

type Shaped = Result<String, serde::de::value::Error>;
type Failure = serde::de::value::Error;

macro_rules! plain {
    ($($method:ident($type:ty) $name:literal;)*) => {
        $(fn $method(self, _: $type) -> Shaped { Ok($name.into()) })*
    };
}

impl<'a> Serializer for Shape<'a> {
    type Ok = String;
    type Error = Failure;
    type SerializeSeq = Parts<'a>;
    type SerializeTuple = Parts<'a>;
    type SerializeTupleStruct = Parts<'a>;
    type SerializeTupleVariant = Parts<'a>;
    type SerializeMap = ser::Impossible<String, Failure>;
    type SerializeStruct = Parts<'a>;
    type SerializeStructVariant = Parts<'a>;

    plain! {
        serialize_bool(bool) "bool";
        serialize_i8(i8) "i8";
        serialize_i16(i16) "i16";
        serialize_i32(i32) "i32";
        serialize_i64(i64) "i64";
        serialize_u8(u8) "u8";
        serialize_u16(u16) "u16";
        serialize_u32(u32) "u32";
        serialize_u64(u64) "u64";
        serialize_f32(f32) "f32";
        serialize_f64(f64) "f64";
        serialize_char(char) "char";
        serialize_str(&str) "str";
        serialize_bytes(&[u8]) "bytes";
    }

    fn serialize_none(self) -> Shaped {
        Ok(format!("Option<{UNKNOWN}>"))
    }

    fn serialize_some<V: Serialize + ?Sized>(self, value: &V) -> Shaped {
        Ok(format!("Option<{}>", value.serialize(self)?))
    }

    fn serialize_unit(self) -> Shaped {
        Ok("()".into())
    }

    fn serialize_unit_struct(self, name: &'static str) -> Shaped {
        Ok(name.into())
    }

    // The current variant depends on the stream, so only the name of the enum and the numbers of its variants are
    // written.
    fn serialize_unit_variant(
        self,
        name: &'static str,
        index: u32,
        variant: &'static str,
    ) -> Shaped {
        learn(self.0, &format!("{name} {index}"), variant.into());
        Ok(name.into())
    }

    fn serialize_newtype_struct<V: Serialize + ?Sized>(
        self,
        name: &'static str,
        value: &V,
    ) -> Shaped {
        let within = value.serialize(Shape(self.0))?;
        Ok(learn(self.0, name, within))
    }

    fn serialize_newtype_variant<V: Serialize + ?Sized>(
        self,
        name: &'static str,
        index: u32,
        variant: &'static str,
        value: &V,
    ) -> Shaped {
        let within = value.serialize(Shape(self.0))?;
        learn(self.0, &format!("{name} {index}"), format!("{variant}({within})"));
        Ok(name.into())
    }

    fn serialize_seq(self, _: Option<usize>) -> Result<Parts<'a>, Failure> {
        Ok(Parts { types: self.0, kind: Of::Sequence, found: Vec::new() })
    }

    fn serialize_tuple(self, _: usize) -> Result<Parts<'a>, Failure> {
        Ok(Parts { types: self.0, kind: Of::Tuple, found: Vec::new() })
    }

    fn serialize_tuple_struct(self, name: &'static str, _: usize) -> Result<Parts<'a>, Failure> {
        Ok(Parts { types: self.0, kind: Of::Struct(name), found: Vec::new() })
    }

    fn serialize_tuple_variant(
        self,
        name: &'static str,
        index: u32,
        variant: &'static str,
        _: usize,
    ) -> Result<Parts<'a>, Failure> {
        Ok(Parts { types: self.0, kind: Of::Variant(name, index, variant), found: Vec::new() })
    }

    fn serialize_map(self, _: Option<usize>) -> Result<Self::SerializeMap, Failure> {
        Err(Failure::custom("no estimator has a map"))
    }

    fn serialize_struct(self, name: &'static str, _: usize) -> Result<Parts<'a>, Failure> {
        Ok(Parts { types: self.0, kind: Of::Struct(name), found: Vec::new() })
    }

    fn serialize_struct_variant(
        self,
        name: &'static str,
        index: u32,
        variant: &'static str,
        _: usize,
    ) -> Result<Parts<'a>, Failure> {
        Ok(Parts { types: self.0, kind: Of::Variant(name, index, variant), found: Vec::new() })
    }

    fn collect_str<V: Display + ?Sized>(self, _: &V) -> Shaped {
        Ok("str".into())
    }

    fn is_human_readable(&self) -> bool {
        false
    }
}

/// A type with parts.
enum Of {
    Sequence,
    Tuple,
    Struct(&'static str),
    Variant(&'static str, u32, &'static str),
}

struct Parts<'a> {
    types: &'a mut Types,
    kind: Of,
    found: Vec<String>,
}

impl Parts<'_> {
    fn part<V: Serialize + ?Sized>(
        &mut self,
        name: Option<&str>,
        value: &V,
    ) -> Result<(), Failure> {
        let shape = value.serialize(Shape(self.types))?;
        self.found.push(name.map_or(shape.clone(), |name| format!("{name}: {shape}")));
        Ok(())
    }

    fn all(self) -> String {
        let Self { types, kind, found: parts } = self;
        let known = |parts: &[String]| parts.iter().find(|part| !part.contains(UNKNOWN)).cloned();
        let first = known(&parts).or_else(|| parts.first().cloned()).unwrap_or(UNKNOWN.into());
        // Some options of an array may have a value.
        let is_array = parts.iter().all(|part| *part == first || part.contains(UNKNOWN));
        match kind {
            Of::Sequence => format!("up to so many {first}"),
            Of::Tuple if is_array => format!("[{first}; {}]", parts.len()),
            Of::Tuple => format!("({})", parts.join(", ")),
            Of::Struct(name) => learn(types, name, parts.join(", ")),
            Of::Variant(name, index, variant) => {
                learn(
                    types,
                    &format!("{name} {index}"),
                    format!("{variant} {{ {} }}", parts.join(", ")),
                );
                name.into()
            }
        }
    }
}

macro_rules! parts {
    ($($trait:ident::$method:ident;)*) => {
        $(impl ser::$trait for Parts<'_> {
            type Ok = String;
            type Error = Failure;

            fn $method<V: Serialize + ?Sized>(&mut self, value: &V) -> Result<(), Failure> {
                self.part(None, value)
            }

            fn end(self) -> Shaped {
                Ok(self.all())
            }
        })*
    };
}

macro_rules! fields {
    ($($trait:ident)*) => {
        $(impl ser::$trait for Parts<'_> {
            type Ok = String;
            type Error = Failure;

            fn serialize_field<V: Serialize + ?Sized>(
                &mut self,
                name: &'static str,
                value: &V,
            ) -> Result<(), Failure> {
                self.part(Some(name), value)
            }

            fn end(self) -> Shaped {
                Ok(self.all())
            }
        })*
    };
}

parts! {
    SerializeSeq::serialize_element;
    SerializeTuple::serialize_element;
    SerializeTupleStruct::serialize_field;
    SerializeTupleVariant::serialize_field;
}

fields!(SerializeStruct SerializeStructVariant);
