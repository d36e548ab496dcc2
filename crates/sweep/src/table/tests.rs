use super::*;
use serde_json::json;

fn columns() -> Vec<Column> {
    vec![
        Column { name: "trial".to_owned(), kind: crate::Kind::Whole },
        Column::number("error_m"),
        Column::text("warning"),
    ]
}

fn rows() -> Vec<Vec<Value>> {
    let number = |trial: f64| if trial % 3.0 == 0.0 { f64::NAN } else { 1.0 / trial };
    let text = |trial: f64| if trial % 2.0 == 0.0 { "" } else { "# one,\ntwo \"three\"" };
    (0..100_000)
        .map(f64::from)
        .map(|trial| vec![Value::Number(trial), number(trial).into(), text(trial).into()])
        .collect()
}

#[test]
fn what_is_written_is_read() {
    let folder = tempfile::tempdir().unwrap();
    let tail = Tail { warnings: vec!["one | two".to_owned()], ..Tail::default() };
    for ending in ENDINGS {
        let path = folder.path().join(format!("rows.{ending}"));
        let mut file = Writer::create(&path, &columns(), &json!({ "plan": "a" })).unwrap();
        assert!(!path.exists());
        for row in rows() {
            file.write(&row).unwrap();
        }
        file.finish(&tail).unwrap();
        let mut reader = Reader::open(&path).unwrap();
        assert_eq!(reader.head["plan"], "a");
        assert_eq!(reader.tail, Tail { rows: 100_000, ..tail.clone() });
        assert_eq!(reader.columns, ["trial", "error_m", "warning"]);
        let mut row = Vec::new();
        for expected in rows() {
            assert!(reader.read(&mut row).unwrap());
            let same = |found: &Value, expected: &Value| match expected {
                Value::Number(number) => {
                    found.number().is_some_and(|it| it.to_bits() == number.to_bits())
                }
                other => found == other,
            };
            assert!(row.iter().zip(&expected).all(|(a, b)| same(a, b)), "{row:?} {expected:?}");
        }
        assert!(!reader.read(&mut row).unwrap());
    }
}

#[test]
fn nothing_is_left_of_a_file_that_was_not_finished() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("rows.csv");
    // What a killed program left.
    std::fs::write(folder.path().join(".rows.csv.1.tmp"), "half").unwrap();
    std::fs::write(folder.path().join(".rows.csv.tmp"), "somebody else's").unwrap();
    let file = Writer::create(&path, &columns(), &json!({})).unwrap();
    let names = || {
        let entries = std::fs::read_dir(folder.path()).unwrap();
        let mut names: Vec<_> =
            entries.map(|it| it.unwrap().file_name().into_string().unwrap()).collect();
        names.sort();
        names
    };
    assert_eq!(names(), [format!(".rows.csv.{}.tmp", process::id()), ".rows.csv.tmp".to_owned()]);
    drop(file);
    assert_eq!(names(), [".rows.csv.tmp"]);
}

#[test]
fn what_no_sweep_wrote_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("rows.csv");
    for text in ["", "a,b\n1,2\n", "# {}\na,b\n1,2\n", "# {}\na,b\n1,2\n# {\"ro", "# {}", "\u{0}"] {
        std::fs::write(&path, text).unwrap();
        let sentence = Reader::open(&path).unwrap_err().to_string();
        assert!(sentence.contains("expected") && !sentence.contains('\n'), "{text}: {sentence}");
    }
    std::fs::write(&path, "# {}\na,b\n1,2\n1,2,3\n# {\"rows\":2}\n").unwrap();
    let mut reader = Reader::open(&path).unwrap();
    let mut row = Vec::new();
    assert!(reader.read(&mut row).unwrap());
    let sentence = reader.read(&mut row).unwrap_err().to_string();
    assert!(sentence.ends_with("rows.csv, line 4: expected 2 values, found 3"), "{sentence}");
    for name in ["rows.json", "rows"] {
        assert!(check_ending(Path::new(name)).is_err());
    }
    assert_eq!(check_ending(Path::new("ROWS.PARQUET")).is_ok(), cfg!(feature = "parquet"));
}
