//! The foot's node on RTIC: the interrupt of the serial port passes bytes to a task of lower priority, which tracks and
//! answers. A byte that arrives meanwhile interrupts it; when idle, the processor sleeps. (Sending polls the port: see
//! `foot-embassy` for interrupts there, too.)

#![no_std]
#![no_main]

#[rtic::app(device = mps2_an386, peripherals = false, dispatchers = [GPIO0])]
mod app {
    use board::CmsdkPort;
    use cortex_m::peripheral::NVIC;
    use foot_node::{FRAME, Node};
    use kestirim_pedestrian::SensorClass;
    use mps2_an386::Interrupt;
    use rtic_sync::channel::{Receiver, Sender};
    use rtic_sync::make_channel;

    /// The number of bytes that may wait for the tracker.
    const ROOM: usize = 64;

    #[shared]
    struct Shared {}

    #[local]
    struct Local {
        arrived: Sender<'static, u8, ROOM>,
    }

    #[init]
    fn init(_: init::Context) -> (Shared, Local) {
        let (arrived, bytes) = make_channel!(u8, ROOM);
        let port = CmsdkPort::first();
        if track::spawn(bytes, port).is_err() {
            // Cannot happen: it is spawned once.
            board::fail();
        }
        (Shared {}, Local { arrived })
    }

    #[idle]
    fn idle(_: idle::Context) -> ! {
        loop {
            cortex_m::asm::wfi();
        }
    }

    #[task(binds = UARTRX0, priority = 2, local = [arrived])]
    fn receive(context: receive::Context) {
        let (arrived, port) = (context.local.arrived, CmsdkPort::served());
        if arrived.is_full() {
            port.postpone();
        } else if let Some(byte) = port.receive() {
            // There is room: this is the only sender.
            let _ = arrived.try_send(byte);
        }
    }

    #[task(priority = 1)]
    async fn track(_: track::Context, mut bytes: Receiver<'static, u8, ROOM>, port: CmsdkPort) {
        let (mut node, mut buffer) = (Node::new(SensorClass::Consumer), [0; FRAME]);
        while let Ok(byte) = bytes.recv().await {
            // There is room again for a byte that the handler may have left in the port.
            NVIC::pend(Interrupt::UARTRX0);
            let Some(answer) = node.take(byte, &mut buffer) else { continue };
            for &byte in answer.frame {
                while !port.send(byte) {}
            }
            if answer.is_last {
                while port.is_sending() {}
                defmt::info!("farewell");
                board::exit();
            }
        }
    }
}
