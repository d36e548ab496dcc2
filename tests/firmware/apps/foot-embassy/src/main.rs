//! The foot's node on embassy: one task awaits bytes and tracks, the other sends the answers, and the interrupts of the
//! serial port connect both to it. Neither task polls: when idle, the processor sleeps.

#![no_std]
#![no_main]

mod serial;

use embassy_executor::Spawner;
use embassy_sync::blocking_mutex::raw::CriticalSectionRawMutex;
use embassy_sync::channel::Channel;
use embedded_io_async::{Read, Write};
use foot_node::{FRAME, Node};
use heapless::Vec;
use kestirim_pedestrian::SensorClass;
use serial::{Receiver, Sender};

/// A frame, and whether it is the last.
type Outgoing = (Vec<u8, FRAME>, bool);

/// The frames to be sent: the tracker only waits once the line has stalled for this many frames.
static OUTGOING: Channel<CriticalSectionRawMutex, Outgoing, 4> = Channel::new();

#[embassy_executor::main]
async fn main(spawner: Spawner) {
    let (receiver, sender) = serial::first();
    match (track(receiver), send(sender)) {
        (Ok(track), Ok(send)) => {
            spawner.spawn(track);
            spawner.spawn(send);
        }
        // Cannot happen: each is spawned once.
        _ => board::fail(),
    }
}

#[embassy_executor::task]
async fn track(mut receiver: Receiver) {
    let mut node = Node::new(SensorClass::Consumer);
    let (mut bytes, mut buffer) = ([0; 32], [0; FRAME]);
    loop {
        let Ok(count) = receiver.read(&mut bytes).await;
        for &byte in bytes.iter().take(count) {
            let Some(answer) = node.take(byte, &mut buffer) else { continue };
            let frame = Vec::from_slice(answer.frame).unwrap_or_default();
            OUTGOING.send((frame, answer.is_last)).await;
        }
    }
}

#[embassy_executor::task]
async fn send(mut sender: Sender) {
    loop {
        let (frame, is_last) = OUTGOING.receive().await;
        let Ok(()) = sender.write_all(&frame).await;
        if is_last {
            let Ok(()) = sender.flush().await;
            defmt::info!("farewell");
            board::exit();
        }
    }
}
