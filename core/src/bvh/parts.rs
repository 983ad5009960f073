//! Two hierarchies under one root.

use super::{Bvh, BvhNode, MAX_DEPTH, build, build_within};
use bytemuck::Zeroable;
use glam::Vec3A;

/// As [`build`], but with the triangles that `moves` says behind the others, in a hierarchy of their own: that of the others
/// depends on them alone. Both are below the root; where either part is empty there is only the other, as `build` makes it.
///
/// # Panics
/// Where `moves` is shorter than `triangles`.
pub fn build_parts(triangles: &[[[f32; 3]; 3]], moves: &[bool]) -> (Bvh, Vec<u32>) {
    let (moving, staying): (Vec<u32>, Vec<u32>) =
        (0..triangles.len() as u32).partition(|&i| moves[i as usize]);
    if moving.is_empty() || staying.is_empty() {
        return build(triangles);
    }
    let (first, mut order) = build_part(triangles, &staying);
    let (second, behind) = build_part(triangles, &moving);
    order.extend(behind);
    (joined(&first, &second, staying.len() as u32), order)
}

/// The hierarchy over some triangles, a level less deep than a whole one, and the triangle in each of its slots.
fn build_part(triangles: &[[[f32; 3]; 3]], part: &[u32]) -> (Bvh, Vec<u32>) {
    let corners: Vec<[[f32; 3]; 3]> = part.iter().map(|&i| triangles[i as usize]).collect();
    let (bvh, order) = build_within(&corners, MAX_DEPTH - 1);
    (bvh, order.into_iter().map(|i| part[i as usize]).collect())
}

/// `first`, which has `slots` slots, and `second` behind it, neither of them empty: a root, their roots, then the nodes of each in their
/// order, which keeps siblings adjacent and subtrees contiguous.
fn joined(first: &Bvh, second: &Bvh, slots: u32) -> Bvh {
    let (a, b) = (first.nodes[0], second.nodes[0]);
    let min = Vec3A::from(a.min).min(b.min.into()).to_array();
    let max = Vec3A::from(a.max).max(b.max.into()).to_array();
    let mut nodes = vec![BvhNode::zeroed(); 3];
    nodes[0] = BvhNode { min, first: 1, max, count: 0 };
    for (root, part, slots) in [(1, first, 0), (2, second, slots)] {
        // Node 1 of the part, the first after its root, is the next here.
        let shift = nodes.len() as u32 - 1;
        nodes[root] = shifted(&part.nodes[0], shift, slots);
        nodes.extend(part.nodes[1..].iter().map(|node| shifted(node, shift, slots)));
    }
    Bvh { nodes, depth: 1 + first.depth.max(second.depth) }
}

/// The node with its children, or its triangles, that many numbers further on.
fn shifted(node: &BvhNode, children: u32, slots: u32) -> BvhNode {
    let by = if node.count > 0 { slots } else { children };
    BvhNode { first: node.first + by, ..*node }
}

#[cfg(test)]
mod tests {
    use super::super::tests::{check, soup};
    use super::*;

    /// That nodes and slots come as a walk that takes the first child first meets them, siblings together.
    fn check_order(bvh: &Bvh) {
        let (mut stack, mut next_node, mut next_slot) = (vec![(0_u32, 0_u32)], 1, 0);
        let mut deepest = 0;
        while let Some((index, depth)) = stack.pop() {
            let node = &bvh.nodes[index as usize];
            deepest = deepest.max(depth);
            if node.count > 0 {
                assert_eq!(node.first, next_slot, "leaf {index}");
                next_slot += node.count;
            } else {
                assert_eq!(node.first, next_node, "node {index}");
                next_node += 2;
                stack.extend([(node.first + 1, depth + 1), (node.first, depth + 1)]);
            }
        }
        assert_eq!((next_node as usize, deepest), (bvh.nodes.len(), bvh.depth));
    }

    #[test]
    fn joined_hierarchies_hold_their_triangles() {
        for (staying, moving) in [(1, 1), (1, 40), (40, 1), (3, 5), (500, 17), (17, 500)] {
            let triangles = soup(staying + moving);
            // Spread over the list, as instances are that move.
            let moves: Vec<bool> =
                (0..staying + moving).map(|i| i * 7919 % (staying + moving) < moving).collect();
            let (bvh, order) = build_parts(&triangles, &moves);
            check(&bvh, &order, &triangles);
            check_order(&bvh);
            let behind: Vec<bool> = order.iter().map(|&i| moves[i as usize]).collect();
            assert_eq!((behind.iter().filter(|moves| **moves).count(), behind.is_sorted()), (moving, true));
        }
    }

    #[test]
    fn a_part_alone_is_the_whole() {
        let triangles = soup(100);
        let whole = build(&triangles);
        for moves in [false, true] {
            let (bvh, order) = build_parts(&triangles, &[moves; 100]);
            assert!(bvh.nodes == whole.0.nodes && bvh.depth == whole.0.depth && order == whole.1);
        }
        assert!(build_parts(&[], &[]).0.nodes.is_empty());
    }

    #[test]
    fn what_stays_does_not_depend_on_what_moves() {
        let staying = soup(300);
        let (alone, order) = build(&staying);
        let far = |t: &[[f32; 3]; 3]| t.map(|p| p.map(|c| c + 1000.0));
        for moving in [soup(50), soup(50).iter().map(far).collect(), soup(900)] {
            let triangles = [&moving[..], &staying].concat();
            let moves: Vec<bool> = (0..triangles.len()).map(|i| i < moving.len()).collect();
            let (bvh, joined) = build_parts(&triangles, &moves);
            let first = joined.iter().take(300).map(|i| i - moving.len() as u32);
            assert!(first.eq(order.iter().copied()));
            assert!((bvh.nodes[1].min, bvh.nodes[1].max) == (alone.nodes[0].min, alone.nodes[0].max));
            let moved =
                |node: &BvhNode| BvhNode { first: node.first + if node.count > 0 { 0 } else { 2 }, ..*node };
            assert!(bvh.nodes[3..].iter().zip(&alone.nodes[1..]).all(|(found, node)| *found == moved(node)));
        }
    }

    #[test]
    fn coinciding_parts_stay_within_the_depth_limit() {
        let nested = |i: usize| [[i as f32, 0.0, 0.0], [-(i as f32), i as f32, 0.0], [0.0, -(i as f32), 1.0]];
        let triangles: Vec<[[f32; 3]; 3]> = (0..20_000).map(nested).chain(vec![soup(1)[0]; 20_000]).collect();
        let moves: Vec<bool> = (0..40_000).map(|i| i >= 20_000).collect();
        let (bvh, order) = build_parts(&triangles, &moves);
        check(&bvh, &order, &triangles);
        check_order(&bvh);
        assert!(bvh.depth <= MAX_DEPTH, "depth {}", bvh.depth);
    }
}
