use std::collections::BTreeSet;

use prost::Message;
use prost::encoding::double;
use prost_types::field_descriptor_proto::{Label, Type};
use prost_types::{DescriptorProto, FieldDescriptorProto, FileDescriptorProto, FileDescriptorSet};

/// The protobuf package of all stream schemas.
const PACKAGE: &str = "kestirim";

/// A protobuf message that holds a row of a stream: a double per column, with field numbers from 1.
#[derive(Debug)]
pub(super) struct Layout {
    name: String,
    fields: Vec<String>,
}

impl Layout {
    /// The message of a stream: its fields are named after the columns, as far as protobuf allows.
    pub(super) fn new(topic: &str, columns: &[String]) -> Self {
        let name = format!("{PACKAGE}.{}", identifier(topic.trim_matches('/')));
        let mut taken = BTreeSet::new();
        let fields = (1..).zip(columns).map(|(number, column)| {
            let mut field = identifier(column);
            while !taken.insert(field.clone()) {
                field = format!("{field}_{number}");
            }
            field
        });
        Self { name, fields: fields.collect() }
    }

    /// The full name of the message.
    pub(super) fn name(&self) -> &str {
        &self.name
    }

    /// The encoded `FileDescriptorSet`, which describes the layout of the message to readers.
    pub(super) fn file_descriptor_set(&self) -> Vec<u8> {
        let field = |(number, name): (i32, &String)| FieldDescriptorProto {
            name: Some(name.clone()),
            number: Some(number),
            label: Some(Label::Optional.into()),
            r#type: Some(Type::Double.into()),
            ..FieldDescriptorProto::default()
        };
        let name = self.name.trim_start_matches(PACKAGE).trim_start_matches('.');
        let message = DescriptorProto {
            name: Some(name.to_owned()),
            field: (1..).zip(&self.fields).map(field).collect(),
            ..DescriptorProto::default()
        };
        let file = FileDescriptorProto {
            name: Some(format!("{PACKAGE}/{name}.proto")),
            package: Some(PACKAGE.to_owned()),
            message_type: vec![message],
            syntax: Some("proto3".to_owned()),
            ..FileDescriptorProto::default()
        };
        FileDescriptorSet { file: vec![file] }.encode_to_vec()
    }

    /// Encodes a row as this message. Zeros are written as well: some readers take an omitted field for a missing
    /// value.
    pub(super) fn message(&self, values: &[f64]) -> Vec<u8> {
        let mut bytes = Vec::with_capacity(10 * self.fields.len());
        for (number, value) in (1..).zip(values).take(self.fields.len()) {
            double::encode(number, value, &mut bytes);
        }
        bytes
    }
}

/// Turns a name into a protobuf identifier: letters, digits and underscores, never beginning with a digit.
fn identifier(name: &str) -> String {
    let allowed = |c: char| if c.is_ascii_alphanumeric() { c } else { '_' };
    let name: String = name.chars().map(allowed).collect();
    if name.starts_with(|c: char| c.is_ascii_alphabetic() || c == '_') {
        name
    } else {
        format!("_{name}")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_become_identifiers_and_stay_apart() {
        let columns = ["x_m", "A-1 m", "A 1 m", "2nd"].map(str::to_owned);
        let layout = Layout::new("/vehicle/ranges", &columns);
        assert_eq!(layout.name(), "kestirim.vehicle_ranges");
        assert_eq!(layout.fields, ["x_m", "A_1_m", "A_1_m_3", "_2nd"]);
    }
}
