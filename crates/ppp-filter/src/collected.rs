use heapless::Vec;

/// Collects as many values as there is room for. (`collect` would panic beyond, and an image would carry its message.)
pub(crate) fn collected<T, const N: usize>(items: impl Iterator<Item = T>) -> Vec<T, N> {
    let mut collected = Vec::new();
    // `for_each` compiles to one loop; a `for` over a filtering iterator becomes two, each with a copy of the filter.
    items.for_each(|item| {
        let _ = collected.push(item);
    });
    collected
}
