use heapless::Vec;

/// What there is room for. (`collect` would panic beyond, and an image would carry the words for it.)
pub(crate) fn collected<T, const N: usize>(items: impl Iterator<Item = T>) -> Vec<T, N> {
    let mut collected = Vec::new();
    for item in items {
        if collected.push(item).is_err() {
            break;
        }
    }
    collected
}
