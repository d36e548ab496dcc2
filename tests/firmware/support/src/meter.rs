//! Measures steps.

use core::hint::black_box;

use crate::counter::Counter;
use crate::image::fail;
use crate::line::line_of_group;
use crate::stack::Painted;
use crate::statistics::Statistics;

/// How deep into the stack a step of an estimator reaches at most, in bytes. All of it is painted for
/// every step, so more takes longer.
const REACH: usize = 8 * 1024;

/// What kind of step it was: each kind has its own statistics.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum Class {
    /// Time went on, no measurement was taken in.
    Predict,
    /// A measurement was taken in.
    Update,
    /// The step answered with an error.
    Rejected,
    /// There was no estimate before the step.
    Start,
}

impl Class {
    const ALL: [(Self, &'static str); 4] = [
        (Self::Predict, "predict"),
        (Self::Update, "update"),
        (Self::Rejected, "rejected"),
        (Self::Start, "start"),
    ];
}

/// Instructions and stack of one call.
#[derive(Clone, Copy)]
struct Cost {
    instructions: u32,
    stack: u32,
}

/// Measures steps; an empty step costs nothing.
pub struct Meter {
    counter: Counter,
    reach: usize,
    empty: Cost,
    classes: [Statistics; Class::ALL.len()],
    stack: u32,
}

impl Default for Meter {
    fn default() -> Self {
        Self::new()
    }
}

impl Meter {
    /// Measures the empty step, to subtract it from all that follow.
    pub fn new() -> Self {
        Self::reaching(REACH)
    }

    /// The same, for steps that reach so many bytes into the stack.
    pub fn reaching(reach: usize) -> Self {
        let mut counter = Counter::new();
        let (_, empty) = cost_of(&mut counter, reach, &mut || Class::Predict);
        Self { counter, reach, empty, classes: [Statistics::EMPTY; Class::ALL.len()], stack: 0 }
    }

    /// Runs and measures one step.
    ///
    /// Fails the image if the step was too long for the counter or too deep for the paint.
    pub fn measure(&mut self, mut step: impl FnMut() -> Class) {
        let (class, cost) = cost_of(&mut self.counter, self.reach, &mut step);
        if let Some(statistics) = self.classes.get_mut(class as usize) {
            statistics.add(cost.instructions.saturating_sub(self.empty.instructions));
        }
        self.stack = self.stack.max(cost.stack.saturating_sub(self.empty.stack));
    }

    /// Tells the host, for each class that occurred, `name.class=steps min max total`, and
    /// `name.stack=bytes` and `name.empty=instructions stack` (what was subtracted).
    pub fn report(&self, name: &str) {
        for ((_, class), statistics) in Class::ALL.iter().zip(&self.classes) {
            if let Some(summary) = statistics.summary() {
                line_of_group(name, class, &summary);
            }
        }
        line_of_group(name, "stack", &[self.stack.into()]);
        line_of_group(name, "empty", &[self.empty.instructions.into(), self.empty.stack.into()]);
    }
}

/// A step behind a reference. (`dyn FnMut` would carry the step's code twice: its table of methods
/// has an entry for `FnOnce`, too, and the flash of an image would be reported too large.)
trait Step {
    fn run(&mut self) -> Class;
}

impl<F: FnMut() -> Class> Step for F {
    fn run(&mut self) -> Class {
        self()
    }
}

/// The one place where steps are called, whichever step it is: behind a reference that the optimiser
/// cannot see through, so that every call costs exactly the same around the step itself.
#[inline(never)]
fn cost_of(counter: &mut Counter, reach: usize, step: &mut dyn Step) -> (Class, Cost) {
    let step = black_box(step);
    let paint = Painted::below(reach);
    counter.start();
    let class = step.run();
    let Some(instructions) = counter.elapsed() else {
        fail("a step took more instructions than the counter can hold");
    };
    let Some(stack) = paint.used() else {
        fail("a step used more stack than is painted");
    };
    (class, Cost { instructions, stack })
}
