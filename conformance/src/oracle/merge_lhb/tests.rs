use super::*;
use twinlight_core::kernels::rasterize_lhb::CAP_FAR;

const ALL: MergeLhbParams =
    MergeLhbParams { first_triangle: 10, layer_cap: 0, cap_side: CAP_NEAR, padding: 0 };

/// Elements of (surface, depth).
fn list(elements: &[(u32, u32)]) -> Vec<LhbElement> {
    elements.iter().map(|&(surface, depth)| LhbElement { surface, depth }).collect()
}

fn lists(lists: &[&[(u32, u32)]], left_out: &[u32]) -> Lists {
    let lists: Vec<_> = lists.iter().map(|l| list(l)).collect();
    Lists { left_out: left_out.to_vec(), ..Lists::of(lists.iter().map(Vec::as_slice)) }
}

#[test]
fn the_nearer_goes_first_and_of_equals_the_kept() {
    let kept = lists(&[&[(1, 5), (4, 7), (2, 7)], &[], &[(0, 1)], &[]], &[]);
    let added = lists(&[&[(3, 4), (0, 7), (1, 9)], &[(2, 3)], &[], &[]], &[]);
    let want =
        lists(&[&[(23, 4), (1, 5), (4, 7), (2, 7), (20, 7), (21, 9)], &[(22, 3)], &[(0, 1)], &[]], &[]);
    assert_eq!(merge(&kept, &added, &ALL), want);
}

#[test]
fn numbers_wrap() {
    let most = MergeLhbParams { first_triangle: (1 << 31) - 1, ..ALL };
    assert_eq!(
        [0, 1, 2, 5, u32::MAX].map(|s| renumbered(s, &most)),
        [u32::MAX - 1, u32::MAX, 0, 3, u32::MAX - 2]
    );
}

#[test]
fn caps_cut_either_end_and_count_it() {
    let kept = lists(&[&[(0, 1), (1, 3)], &[(2, 9)]], &[4, u32::MAX]);
    let added = lists(&[&[(0, 2), (1, 3)], &[(2, 8)]], &[5, 0]);
    let near = merge(&kept, &added, &MergeLhbParams { layer_cap: 1, ..ALL });
    assert_eq!(near, lists(&[&[(0, 1)], &[(22, 8)]], &[12, 0]));
    let far = merge(&kept, &added, &MergeLhbParams { layer_cap: 3, cap_side: CAP_FAR, ..ALL });
    assert_eq!(far, lists(&[&[(20, 2), (1, 3), (21, 3)], &[(22, 8), (2, 9)]], &[10, u32::MAX]));
}

#[test]
fn no_lists_are_no_lists() {
    let none = lists(&[], &[]);
    assert_eq!(merge(&none, &none, &ALL).offsets, [0]);
}
