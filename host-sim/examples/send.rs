//! Sends synthetic measurements to `host-sim live`, each in its own datagram and at the pace of the recording:
//! `cargo run --release -p host-sim --example send -- --system robot`.

use std::error::Error;
use std::net::UdpSocket;
use std::thread::sleep;
use std::time::{Duration, Instant};

use clap::{Parser, ValueEnum};
use host_sim::random::{normal, stream};
use host_sim::systems::pedestrian::simulate::{scenario::Scenario, sensor};
use host_sim::systems::robot::simulate::scenario::{Office, line};
use host_sim::systems::uav::simulate::scenario::{INTERVAL_S, Inputs, SAMPLES, fly};
use kestirim_replay::robot::RangeRow;
use kestirim_replay::uav::{Noise, Plant};
use kestirim_telemetry::{CAPACITY, Flight, Imu, Message, PathLoss, Range, encode};

#[derive(Parser)]
struct Options {
    /// Where `host-sim live` listens
    #[arg(long, value_name = "ADDR:PORT", default_value = "127.0.0.1:5775")]
    udp: String,
    /// What is sent
    #[arg(long, value_enum, default_value_t = System::Pedestrian)]
    system: System,
    /// So many times as fast as it was measured
    #[arg(long, value_name = "FACTOR", default_value_t = 1.0)]
    speed: f64,
    /// Of all randomness
    #[arg(long, default_value_t = 0)]
    seed: u64,
}

#[derive(Clone, Copy, ValueEnum)]
enum System {
    /// The walk through the paper's flat, at 100 Hz
    Pedestrian,
    /// The robot's straight line through the paper's office
    Robot,
    /// A drone that looks for a user at 100 m, 100 m over open ground, for four minutes
    Drone,
    /// Ten seconds of P3 (Navion), as deviations
    Uav,
}

/// The measurements with their times (µs), in chronological order.
fn measurements(system: System, seed: u64) -> Vec<(u64, Message)> {
    let mut rng = stream(seed, 0);
    match system {
        System::Pedestrian => {
            let ideal = Scenario::draw(&mut rng).ideal_imu(100.0);
            let imu = |sample: host_sim::systems::pedestrian::Sample| {
                let [specific_force, angular_rate] =
                    [sample.specific_force, sample.angular_rate].map(|axes| axes.map(|v| v as f32));
                let time_us = sample.time_us;
                (time_us, Imu { time_us, specific_force, angular_rate }.into())
            };
            sensor::measure(&mut rng, &ideal, 100.0).into_iter().map(imu).collect()
        }
        System::Robot => {
            let rows = Office::draw(&mut rng).measure(&mut rng, &line());
            let range = |row: RangeRow| {
                let (time_us, anchor) = (row.time_us as u64, row.anchor as u16);
                Some((time_us, Range { time_us, anchor, range: row.range? as f32 }.into()))
            };
            rows.into_iter().filter_map(range).collect()
        }
        System::Drone => (0..240_u64)
            .map(|second| {
                let [x, y] = [0.065, 0.105].map(|rate| 200.0 * (second as f64 * rate).sin());
                let place = [x, y, 50.0];
                let distance = (place[0] - 100.0).hypot(place[1] - 100.0).hypot(place[2]);
                // The path loss over open ground at 2 GHz, with shadowing.
                let loss = 38.5 + 20.0 * distance.log10() + normal(&mut rng, 3.0);
                let (time_us, place) = (second * 1_000_000, place.map(|metres| metres as f32));
                (time_us, PathLoss { time_us, place, loss: loss as f32 }.into())
            })
            .collect(),
        System::Uav => {
            let start = [0.0, 0.0, 2.0, 0.05].into();
            let flight =
                fly(Plant::P3.discrete(INTERVAL_S), start, Inputs::Sine, Noise::SENSORS, rng);
            let message =
                |(number, sample): (usize, host_sim::systems::uav::simulate::scenario::Sample)| {
                    let time_us = (number as f64 * INTERVAL_S * 1e6).round() as u64;
                    let inputs = [0, 1].map(|input| sample.u[input] as f32);
                    let outputs = [1, 2, 3].map(|state| sample.y[state] as f32);
                    (time_us, Flight { time_us, inputs, outputs }.into())
                };
            flight.take(SAMPLES).enumerate().map(message).collect()
        }
    }
}

fn main() -> Result<(), Box<dyn Error>> {
    let options = Options::parse();
    let socket = UdpSocket::bind("0.0.0.0:0")?;
    socket.connect(&options.udp)?;
    let begun = Instant::now();
    let mut sequence = 0_u16;
    for (time_us, message) in measurements(options.system, options.seed) {
        let due = Duration::try_from_secs_f64(time_us as f64 * 1e-6 / options.speed)?;
        sleep(due.saturating_sub(begun.elapsed()));
        socket.send(encode(&message, sequence, &mut [0; CAPACITY])?)?;
        sequence = sequence.wrapping_add(1);
    }
    eprintln!("{sequence} frames sent to {}", options.udp);
    Ok(())
}
