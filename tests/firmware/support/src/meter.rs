//! Measures the costs of steps.

use core::hint::black_box;

use crate::counter::Counter;
use crate::image::fail;
use crate::line::line_of_group;
use crate::stack::Painted;
use crate::statistics::Statistics;

/// The largest depth of the stack that a step of an estimator uses, bytes. All of it is painted for every step, so a
/// larger value takes longer.
const REACH: usize = 8 * 1024;

/// The class of a step; each class has its own statistics.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum Class {
    /// Time advanced, without a measurement.
    Predict,
    /// A measurement was processed.
    Update,
    /// The step returned an error.
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

/// The instructions and stack of one call.
#[derive(Clone, Copy)]
struct Cost {
    instructions: u32,
    stack: u32,
}

/// A meter for steps, for which an empty step costs nothing.
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
    /// Creates a meter and measures the empty step, which is subtracted from all that follow.
    pub fn new() -> Self {
        Self::reaching(REACH)
    }

    /// Creates a meter for steps that use up to `reach` bytes of stack.
    pub fn reaching(reach: usize) -> Self {
        let mut counter = Counter::new();
        let (_, empty) = cost_of(&mut counter, reach, &mut || Class::Predict);
        Self { counter, reach, empty, classes: [Statistics::EMPTY; Class::ALL.len()], stack: 0 }
    }

    /// Runs and measures one step.
    ///
    /// Ends the image with a failure if the step was too long for the counter or too deep for the paint.
    pub fn measure(&mut self, mut step: impl FnMut() -> Class) {
        let (class, cost) = cost_of(&mut self.counter, self.reach, &mut step);
        if let Some(statistics) = self.classes.get_mut(class as usize) {
            statistics.add(cost.instructions.saturating_sub(self.empty.instructions));
        }
        self.stack = self.stack.max(cost.stack.saturating_sub(self.empty.stack));
    }

    /// Prints, for each class that occurred, `name.class=steps min max total`, and `name.stack=bytes` and
    /// `name.empty=instructions stack` (what was subtracted).
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

/// A step behind a reference. (`dyn FnMut` would contain the step's code twice: its vtable also has an entry for
/// `FnOnce`, and the flash of an image would be reported too large.)
trait Step {
    fn run(&mut self) -> Class;
}

impl<F: FnMut() -> Class> Step for F {
    fn run(&mut self) -> Class {
        self()
    }
}

/// The single place where all steps are called, behind a reference that the optimiser cannot see through, so that every
/// call has exactly the same overhead around the step itself.
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
