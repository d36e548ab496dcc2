use std::fs;

use prost_reflect::{DescriptorPool, DynamicMessage, Value};

use super::*;

/// Reads a file as a viewer would: topic, time in nanoseconds and the message, decoded by the schema in the file.
fn read(bytes: &[u8]) -> Vec<(String, u64, DynamicMessage)> {
    let messages = ::mcap::MessageStream::new(bytes).unwrap();
    messages
        .map(|message| {
            let message = message.unwrap();
            let schema = message.channel.schema.as_ref().unwrap();
            assert_eq!(
                (schema.encoding.as_str(), &*message.channel.message_encoding),
                ("protobuf", "protobuf")
            );
            let pool = DescriptorPool::decode(&*schema.data).unwrap();
            let descriptor = pool.get_message_by_name(&schema.name).unwrap();
            let decoded = DynamicMessage::decode(descriptor, &*message.data).unwrap();
            assert_eq!(message.log_time, message.publish_time);
            (message.channel.topic.clone(), message.log_time, decoded)
        })
        .collect()
}

fn written(streams: &[Stream]) -> Vec<u8> {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("run.mcap");
    write(&path, streams).unwrap();
    fs::read(path).unwrap()
}

fn number(message: &DynamicMessage, field: &str) -> f64 {
    message.get_field_by_name(field).and_then(|value| value.as_f64()).unwrap()
}

/// The value at a path of fields, such as `pose.position.x`.
fn nested(message: &DynamicMessage, path: &str) -> Value {
    let mut value = Value::Message(message.clone());
    for field in path.split('.') {
        value = match field.parse::<usize>() {
            Ok(index) => value.as_list().unwrap()[index].clone(),
            Err(_) => value.as_message().unwrap().get_field_by_name(field).unwrap().into_owned(),
        };
    }
    value
}

fn walk() -> Stream {
    let columns: Vec<_> = ["x_m", "y_m", "z_m"]
        .into_iter()
        .map(str::to_owned)
        .chain((3..20).map(|i| format!("c{i}")))
        .collect();
    let row = |step: i32| {
        let values: Vec<f64> =
            (0..20).map(|column| f64::from(step) / 3.0 + f64::from(column)).collect();
        (f64::from(step) / 10.0, values)
    };
    let mut rows: Vec<_> = (0..100).map(row).collect();
    rows[40].1[1] = f64::NAN;
    Stream { topic: "/walker/estimate".to_owned(), columns, rows }
}

#[test]
fn every_value_is_read_back_by_the_schema_of_the_file() {
    let stream = walk();
    let read = read(&written(std::slice::from_ref(&stream)));
    let rows: Vec<_> = read.iter().filter(|(topic, ..)| *topic == stream.topic).collect();
    assert_eq!(rows.len(), stream.rows.len());
    for ((_, time, message), (seconds, values)) in rows.iter().zip(&stream.rows) {
        assert_eq!(*time, (seconds * 1e9).round() as u64);
        for (column, value) in stream.columns.iter().zip(values) {
            assert_eq!(number(message, column).to_bits(), value.to_bits(), "{column}");
        }
    }
}

#[test]
fn places_are_poses_and_one_path_with_a_gap_where_there_is_none() {
    let read = read(&written(&[walk()]));
    let on = |topic: &str| read.iter().filter(|(t, ..)| t == topic).collect::<Vec<_>>();
    let (poses, paths) = (on("/walker/estimate/pose"), on("/walker/estimate/path"));
    assert_eq!((poses.len(), paths.len()), (99, 1));
    let (_, time, pose) = poses[30];
    assert_eq!(*time, 3_000_000_000);
    assert_eq!(nested(pose, "pose.position.y"), Value::F64(11.0));
    assert_eq!(nested(pose, "timestamp.seconds"), Value::I64(3));
    let (_, _, path) = paths[0];
    let lines = nested(path, "entities.0.lines");
    let lengths = lines
        .as_list()
        .unwrap()
        .iter()
        .map(|line| nested(line.as_message().unwrap(), "points").as_list().unwrap().len());
    assert_eq!(lengths.collect::<Vec<_>>(), [40, 59]);
    assert_eq!(nested(path, "entities.0.lines.1.points.0.x"), Value::F64(41.0 / 3.0));
    assert_eq!(nested(path, "entities.0.lines.1.color.a"), Value::F64(1.0));
    assert_eq!(nested(path, "entities.0.lines.1.type"), Value::EnumNumber(0));
    assert_eq!(nested(path, "entities.0.lines.1.thickness"), Value::F64(2.0));
    assert_eq!(nested(path, "entities.0.lines.1.scale_invariant"), Value::Bool(true));
    assert_eq!(nested(path, "entities.0.id"), Value::String("/walker/estimate".to_owned()));
    assert_eq!(nested(path, "entities.0.timestamp.nanos"), Value::I32(0));
    assert_eq!(nested(pose, "pose.orientation.w"), Value::F64(1.0));
    assert_eq!(nested(pose, "frame_id"), Value::String("world".to_owned()));
}

#[test]
fn streams_are_merged_by_time_and_moved_together_if_they_begin_before_0() {
    let fast = Stream::new("/a", &["v"], vec![(-1.5, vec![1.0]), (0.5, vec![2.0])]);
    let slow = Stream::new("/b", &["v"], vec![(-0.5, vec![3.0]), (0.5, vec![0.0])]);
    let bytes = written(&[fast, slow]);
    let seen: Vec<_> = read(&bytes)
        .iter()
        .map(|(topic, time, m)| (topic.clone(), *time, number(m, "v")))
        .collect();
    let expected = [
        ("/a", 500_000_000, 1.0),
        ("/b", 1_500_000_000, 3.0),
        ("/a", 2_500_000_000, 2.0),
        ("/b", 2_500_000_000, 0.0),
    ];
    assert_eq!(seen, expected.map(|(topic, time, value)| (topic.to_owned(), time, value)));
    let summary = ::mcap::Summary::read(&bytes).unwrap().unwrap();
    let clock = ::mcap::read::metadata(&bytes, &summary.metadata_indexes[0]).unwrap();
    assert_eq!(clock.metadata["zero_s"], "-2");
}

#[test]
fn the_same_streams_give_the_same_bytes() {
    let streams: Vec<_> =
        (0..40).map(|index| Stream { topic: format!("/walker/{index}"), ..walk() }).collect();
    assert_eq!(written(&streams), written(&streams));
    assert_eq!(read(&written(&[])).len(), 0);
}

#[test]
fn a_time_that_is_none_is_refused_in_a_sentence_and_nothing_is_written() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("run.mcap");
    let refused =
        write(&path, &[Stream::new("/a", &["v"], vec![(f64::NAN, vec![1.0])])]).unwrap_err();
    assert!(refused.to_string().ends_with("a time of NaN s cannot be written"), "{refused}");
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 0);
}
