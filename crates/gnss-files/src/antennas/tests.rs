use super::*;
use crate::samples::{antennas, sentences, text};

const RECEIVER: &str = "ANT  TYPE       DOME";

#[test]
fn patterns_are_read_in_metres() -> Result<(), Error> {
    let antennas = Antennas::parse(&[text(antennas())], RECEIVER)?;
    assert_eq!(sentences(&antennas.warnings), [""; 0]);
    let receiver = antennas.receiver.expect("it is there");
    assert_eq!(receiver.name, RECEIVER);
    let [_, l2] = receiver.on(Carriers::L1L2).expect("two frequencies");
    assert_eq!(l2.offset, [1.5e-3, -2.5e-3, 0.1]);
    assert_eq!((l2.first, l2.step, l2.azimuth_step), (0.0, 5.0, 180.0));
    assert_eq!(l2.mean, [1e-3, 2e-3, -3.25e-3]);
    assert_eq!(l2.by_azimuth.len(), 9);
    assert_eq!(l2.by_azimuth[3..6], [4e-3, 5e-3, 6e-3]);
    Ok(())
}

#[test]
fn satellites_change_their_numbers() -> Result<(), Error> {
    let antennas = Antennas::parse(&[text(antennas())], RECEIVER)?;
    let at = |year| GpsTime::from_calendar([year, 1, 1, 0, 0], 0.0).expect("a day");
    assert_eq!(antennas.satellite(5, at(2000)), None);
    assert_eq!(
        antennas.satellite(5, at(2010)).and_then(|one| one.valid_until).map(GpsTime::day),
        Some(56_473)
    );
    assert_eq!(antennas.satellite(5, at(2020)).and_then(|one| one.valid_until), None);
    let without_l2 =
        antennas.satellite(5, at(2020)).is_some_and(|one| one.on(Carriers::L1L2).is_none());
    assert!(without_l2);
    assert_eq!(antennas.satellite(6, at(2020)), None);
    Ok(())
}

#[test]
fn an_unknown_radome_or_antenna_is_told() -> Result<(), Error> {
    let near = Antennas::parse(&[text(antennas())], "ANT  TYPE       SNOW")?;
    assert_eq!(near.receiver.expect("one without radome").name, "ANT  TYPE       NONE");
    assert!(
        sentences(&near.warnings)[0]
            .contains("\"ANT  TYPE       SNOW\": it is taken without its radome")
    );
    let far = Antennas::parse(&[text(antennas())], "TIN CAN")?;
    assert_eq!(far.receiver, None);
    assert!(sentences(&far.warnings)[0].contains("\"TIN CAN\": it is left out"));
    Ok(())
}

#[test]
fn satellites_of_galileo_are_moved_between_editions_as_igs20_tells() -> Result<(), Error> {
    let at = GpsTime::from_calendar([2020, 1, 1, 0, 0], 0.0).expect("a day");
    let of = |kind: &str, code: &str, edition: &str| {
        let satellite =
            antennas().replace("BLOCK IIF ", &format!("{kind:10}")).replace("G050", code);
        let told = format!("{edition:60}SINEX CODE\n     0.0{:52}DAZI", "");
        let file = satellite.replace(&format!("     0.0{:52}DAZI", ""), &told);
        let antennas = Antennas::parse(&[text(file)], RECEIVER)?;
        Ok::<_, Error>(antennas.satellite(5, at).expect("it is there").clone())
    };
    let z = |antenna: &Antenna| {
        antenna.centres.first().map(|(_, centre)| (centre.offset[2] * 1e5).round())
    };
    let galileo = of("GALILEO-2", "E210", "IGS20_2417")?;
    assert_eq!((galileo.model, galileo.code.as_str()), (Some(AntennaModel::Igs20), "E210"));
    assert_eq!(z(&galileo), Some(10_000.0));
    let before = galileo.in_model(AntennaModel::Igs14).expect("igs20.atx tells it");
    assert_eq!((z(&before), before.model), (Some(-5_573.0), Some(AntennaModel::Igs14)));
    assert_eq!(before.in_model(AntennaModel::Igs20).as_ref().and_then(z), Some(10_000.0));
    assert_eq!(galileo.in_model(AntennaModel::Igs20).as_ref().and_then(z), Some(10_000.0));
    assert_eq!(galileo.in_model(AntennaModel::Igs08), None);
    // Offsets that were estimated one by one, and an antenna without an edition.
    assert_eq!(of("BLOCK IIF", "G050", "IGS20_2417")?.in_model(AntennaModel::Igs14), None);
    assert_eq!(of("GALILEO-1", "E102", "IGS20_2417")?.in_model(AntennaModel::Igs14), None);
    let silent = of("BLOCK IIF", "G050", "OWN")?;
    assert_eq!(silent.model, None);
    assert_eq!(silent.in_model(AntennaModel::Igs14), Some(silent));
    Ok(())
}

#[test]
fn damage_is_located() {
    let complaint =
        |file: &str| Antennas::parse(&[text(file)], RECEIVER).expect_err(file).to_string();
    let file = antennas().replace("-3.25", "-3,25");
    assert!(complaint(&file).ends_with("expected a phase centre variation in mm, found \"-3,25\""));
    let file = antennas().replace("     0.0  10.0   5.0", "     0.0  10.0   0.0");
    assert!(complaint(&file).contains("expected the angles of the pattern before it"));
    assert!(complaint("antenna\n").contains("found \"antenna\""));
}
