//! Rows as Parquet, without Arrow: every column is one of optional numbers or texts.

use std::fmt;
use std::fs::File;
use std::io;
use std::path::Path;
use std::sync::Arc;

use parquet::basic::{Compression, LogicalType, Repetition, Type as Physical};
use parquet::data_type::{ByteArray, ByteArrayType, DoubleType, Int64Type};
use parquet::errors::ParquetError;
use parquet::file::metadata::KeyValue;
use parquet::file::properties::WriterProperties;
use parquet::file::reader::FileReader;
use parquet::file::serialized_reader::SerializedFileReader;
use parquet::file::writer::{SerializedFileWriter, SerializedRowGroupWriter};
use parquet::record::Field;
use parquet::record::reader::RowIter;
use parquet::schema::types::{Type, TypePtr};

use super::Told;
use crate::{Column, Error, Kind, Value};

/// The keys of the head and the tail in the file's metadata.
const HEAD: &str = "kestirim";
const TAIL: &str = "kestirim.end";
/// The number of rows that are kept in memory until they are written together.
const GROUP: usize = 65_536;

pub(super) struct Writer {
    file: SerializedFileWriter<File>,
    columns: Vec<Column>,
    rows: Vec<Vec<Value>>,
}

impl fmt::Debug for Writer {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Writer").field("columns", &self.columns).finish_non_exhaustive()
    }
}

impl Writer {
    pub(super) fn new(file: File, columns: &[Column], head: String) -> io::Result<Self> {
        let fields = columns.iter().map(field).collect::<Result<Vec<_>, _>>().map_err(other)?;
        let schema = Type::group_type_builder("rows").with_fields(fields).build().map_err(other)?;
        let properties = WriterProperties::builder()
            .set_compression(Compression::SNAPPY)
            .set_key_value_metadata(Some(vec![KeyValue::new(HEAD.to_owned(), head)]))
            .build();
        let file = SerializedFileWriter::new(file, Arc::new(schema), Arc::new(properties));
        Ok(Self { file: file.map_err(other)?, columns: columns.to_vec(), rows: Vec::new() })
    }

    pub(super) fn write(&mut self, row: &[Value]) -> io::Result<()> {
        self.rows.push(row.to_vec());
        if self.rows.len() == GROUP { self.write_group().map_err(other) } else { Ok(()) }
    }

    fn write_group(&mut self) -> Result<(), ParquetError> {
        let rows = std::mem::take(&mut self.rows);
        if rows.is_empty() {
            return Ok(());
        }
        let mut group = self.file.next_row_group()?;
        for (place, column) in self.columns.iter().enumerate() {
            write_column(&mut group, &rows, place, column.kind)?;
        }
        group.close()?;
        Ok(())
    }

    pub(super) fn finish(mut self, tail: String) -> io::Result<File> {
        self.write_group().map_err(other)?;
        self.file.append_key_value_metadata(KeyValue::new(TAIL.to_owned(), tail));
        self.file.into_inner().map_err(other)
    }
}

fn write_column(
    group: &mut SerializedRowGroupWriter<'_, File>,
    rows: &[Vec<Value>],
    place: usize,
    kind: Kind,
) -> Result<(), ParquetError> {
    let Some(mut writer) = group.next_column()? else { return Ok(()) };
    let values = || rows.iter().map(|row| row.get(place).unwrap_or(&Value::Missing));
    let levels: Vec<i16> = values().map(|value| i16::from(*value != Value::Missing)).collect();
    let there = || values().filter(|value| **value != Value::Missing);
    let numbers = || there().map(|value| value.number().unwrap_or(f64::NAN));
    match kind {
        Kind::Whole => {
            let whole: Vec<i64> = numbers().map(|number| number as i64).collect();
            writer.typed::<Int64Type>().write_batch(&whole, Some(&levels), None)?;
        }
        Kind::Number => {
            let numbers: Vec<f64> = numbers().collect();
            writer.typed::<DoubleType>().write_batch(&numbers, Some(&levels), None)?;
        }
        Kind::Text => {
            let texts: Vec<_> =
                there().map(|value| ByteArray::from(value.to_string().into_bytes())).collect();
            writer.typed::<ByteArrayType>().write_batch(&texts, Some(&levels), None)?;
        }
    }
    writer.close()
}

fn field(column: &Column) -> Result<TypePtr, ParquetError> {
    let (physical, logical) = match column.kind {
        Kind::Whole => (Physical::INT64, None),
        Kind::Number => (Physical::DOUBLE, None),
        Kind::Text => (Physical::BYTE_ARRAY, Some(LogicalType::String)),
    };
    let field = Type::primitive_type_builder(&column.name, physical);
    let field = field.with_repetition(Repetition::OPTIONAL).with_logical_type(logical);
    Ok(Arc::new(field.build()?))
}

fn other(error: ParquetError) -> io::Error {
    io::Error::other(error)
}

pub(super) struct Reader {
    rows: RowIter<'static>,
}

impl fmt::Debug for Reader {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Reader").finish_non_exhaustive()
    }
}

impl Reader {
    pub(super) fn open(path: &Path) -> Result<(Told, Self), Error> {
        let file = File::open(path).map_err(Error::read(path))?;
        let reader = SerializedFileReader::new(file).map_err(|error| wrong(path, &error))?;
        let metadata = reader.metadata().file_metadata();
        let told = |key: &str| {
            let pairs = metadata.key_value_metadata().into_iter().flatten();
            let value = pairs.filter(|pair| pair.key == key).find_map(|pair| pair.value.clone());
            value.unwrap_or_default()
        };
        let columns = metadata.schema_descr().columns();
        let columns = columns.iter().map(|column| column.name().to_owned()).collect();
        let told = Told { head: told(HEAD), tail: told(TAIL), columns };
        Ok((told, Self { rows: RowIter::from_file_into(Box::new(reader)) }))
    }

    pub(super) fn read(&mut self, path: &Path, row: &mut Vec<Value>) -> Result<bool, Error> {
        let Some(next) = self.rows.next() else { return Ok(false) };
        let next = next.map_err(|error| wrong(path, &error))?;
        row.extend(next.get_column_iter().map(|(_, field)| match field {
            Field::Double(number) => Value::from(*number),
            Field::Long(whole) => Value::from(*whole as f64),
            Field::Str(text) => Value::from(text.as_str()),
            _ => Value::Missing,
        }));
        Ok(true)
    }
}

fn wrong(path: &Path, error: &ParquetError) -> Error {
    Error::file(path, error.to_string().lines().collect::<Vec<_>>().join("; "))
}
