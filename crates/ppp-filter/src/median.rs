/// The median, or `None` without values. Found by counting, as sorting would bring in panics.
#[inline(never)] // Wanted at several places, once in flash.
pub(crate) fn median(values: &[f64]) -> Option<f64> {
    let middle = values.len() / 2;
    values.iter().copied().find(|candidate| {
        let below = values.iter().filter(|other| other.total_cmp(candidate).is_lt()).count();
        let up_to = values.iter().filter(|other| other.total_cmp(candidate).is_le()).count();
        below <= middle && middle < up_to
    })
}
