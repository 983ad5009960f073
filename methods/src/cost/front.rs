//! The settings that no other beats.

use std::cmp::Ordering;

/// Whether each (time, error) is on the Pareto front: none is better in one and at least as good in the other. Equal ones are on it
/// together; what is infinite or not a number never is.
///
/// ```
/// use twinlight_methods::cost::front;
///
/// let points = [(1.0, 0.5), (2.0, 0.1), (3.0, 0.2), (4.0, f64::NAN)];
/// assert_eq!(front(&points), [true, true, false, false]);
/// ```
pub fn front(points: &[(f64, f64)]) -> Vec<bool> {
    let mut order: Vec<usize> = (0..points.len()).collect();
    order.retain(|&i| points[i].0.is_finite() && points[i].1.is_finite());
    order.sort_by(|&a, &b| points[a].partial_cmp(&points[b]).unwrap_or(Ordering::Equal));
    let mut on_front = vec![false; points.len()];
    let mut last: Option<(f64, f64)> = None;
    for i in order {
        // Sorted by time, then by error: a point is beaten unless its error is below that of all faster ones.
        if last.is_none_or(|last| points[i].1 < last.1 || points[i] == last) {
            on_front[i] = true;
            last = Some(points[i]);
        }
    }
    on_front
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn beats(a: (f64, f64), b: (f64, f64)) -> bool {
        a.0 <= b.0 && a.1 <= b.1 && (a.0 < b.0 || a.1 < b.1)
    }

    #[test]
    fn ties_and_what_is_no_number() {
        assert_eq!(front(&[]), Vec::<bool>::new());
        assert_eq!(front(&[(1.0, 1.0), (1.0, 1.0), (1.0, 2.0), (2.0, 1.0)]), [true, true, false, false]);
        let nan = f64::NAN;
        assert_eq!(
            front(&[(nan, 0.0), (0.0, nan), (f64::INFINITY, 0.0), (5.0, 5.0)]),
            [false, false, false, true]
        );
        assert_eq!(front(&[(0.0, 0.0), (-0.0, 0.0)]), [true, true]);
    }

    /// Few different values, so that there are ties; one of them is not a number.
    fn value() -> impl Strategy<Value = f64> {
        prop_oneof![9 => (0..6_i32).prop_map(f64::from), 1 => Just(f64::NAN)]
    }

    proptest! {
        #[test]
        fn none_on_the_front_is_beaten_and_every_other_is(
            points in proptest::collection::vec((value(), value()), 0..40),
        ) {
            let on_front = front(&points);
            for (i, &point) in points.iter().enumerate() {
                let is_number = !point.0.is_nan() && !point.1.is_nan();
                let beaten = points.iter().any(|&other| beats(other, point));
                prop_assert_eq!(on_front[i], is_number && !beaten, "{:?} of {:?}", point, points);
            }
        }
    }
}
