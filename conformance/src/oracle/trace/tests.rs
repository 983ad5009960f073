use super::*;

fn unit(id: u32, z: f32) -> Triangle {
    Triangle::new([[0.0, 0.0, z], [1.0, 0.0, z], [0.0, 1.0, z]], id, 0)
}

fn down(x: f32, y: f32) -> Ray {
    Ray { origin: [x, y, 2.0], t_min: 0.0, direction: [0.0, 0.0, -1.0], t_max: f32::INFINITY }
}

#[test]
fn a_plain_hit_is_decided_and_tight() {
    let allowed = closest(&[unit(0, 0.0), unit(1, 1.0)], &down(0.25, 0.5));
    assert!(allowed.is_decided(), "{allowed:?}");
    let (id, hit) = allowed.hits[0];
    assert_eq!(id, 1);
    assert!(hit.t.low <= 1.0 && hit.t.high >= 1.0 && hit.t.high - hit.t.low < 1e-5, "{hit:?}");
    assert!(hit.u.low <= 0.25 && hit.u.high >= 0.25 && hit.u.high - hit.u.low < 1e-5, "{hit:?}");
    assert!(hit.v.low <= 0.5 && hit.v.high >= 0.5, "{hit:?}");
}

#[test]
fn edges_and_equal_distances_leave_a_choice() {
    let on_edge = closest(&[unit(0, 0.0)], &down(0.5, 0.5));
    assert!(on_edge.miss && on_edge.hits.len() == 1, "{on_edge:?}");
    let twins = closest(&[unit(0, 0.0), unit(1, 0.0)], &down(0.25, 0.25));
    assert!(!twins.miss && twins.hits.len() == 2, "{twins:?}");
}

#[test]
fn outside_behind_and_out_of_range_are_certain_misses() {
    let nothing = Allowed { hits: vec![], miss: true };
    let ray = down(0.25, 0.25);
    assert_eq!(closest(&[unit(0, 0.0)], &down(0.6, 0.6)), nothing);
    assert_eq!(closest(&[unit(0, 3.0)], &ray), nothing);
    assert_eq!(closest(&[unit(0, 0.0)], &Ray { t_max: 1.9, ..ray }), nothing);
    assert_eq!(closest(&[unit(0, 0.0)], &Ray { t_min: 2.1, ..ray }), nothing);
    assert_eq!(occluded(&[unit(0, 0.0)], &ray), Some(true));
    assert_eq!(occluded(&[unit(0, 0.0)], &Ray { t_max: 1.9, ..ray }), Some(false));
}

#[test]
fn the_formula_as_written_stays_within_the_intervals() {
    let scene = crate::scenes::soup(200, 9);
    let mut rays = crate::scenes::Rays::new(&scene, 5);
    let mut decided = 0;
    for _ in 0..2000 {
        let ray = rays.incoherent();
        let (got, allowed) = (closest_as_written(&scene.triangles, &ray), closest(&scene.triangles, &ray));
        decided += usize::from(allowed.is_decided());
        if got.triangle == NO_HIT {
            assert!(allowed.miss, "{ray:?}: {allowed:?}");
            continue;
        }
        let hit = allowed.hits.iter().find(|(id, _)| *id == got.triangle);
        let (_, hit) = hit.unwrap_or_else(|| panic!("{ray:?}: {got:?} not in {allowed:?}"));
        for (x, range) in [(got.t, hit.t), (got.u, hit.u), (got.v, hit.v)] {
            assert!(
                f64::from(x) >= range.low && f64::from(x) <= range.high,
                "{ray:?}: {got:?} not in {hit:?}"
            );
        }
    }
    assert!(decided > 1900, "the oracle decides only {decided} of 2000");
}
