use heapless::Vec;

/// As many values as there is room for. (`collect` would panic beyond, and an image would carry its message.)
pub(crate) fn collected<T, const N: usize>(items: impl Iterator<Item = T>) -> Vec<T, N> {
    let mut collected = Vec::new();
    for item in items {
        if collected.push(item).is_err() {
            break;
        }
    }
    collected
}
