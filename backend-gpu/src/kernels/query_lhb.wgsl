// kernel family: query_lhb
// contract core/src/kernels/query_lhb.rs
// cpu backend-cpu/src/kernels/query_lhb.rs
// gpu backend-gpu/src/kernels/query_lhb.wgsl
// oracle conformance/src/oracle/query_lhb.rs
//
// One query per invocation; what it meets is in shared/look_up.wgsl.

const WORKGROUP_SIZE: u32 = 64u;

struct QueryLhbBlock {
    lhb: LhbHeader,
    query_count: u32,
    // For loops_run.
    loop_rounds: u32,
    padding: vec2<u32>,
}

@group(0) @binding(0) var<uniform> params: QueryLhbBlock;
@group(0) @binding(7) var<storage, read_write> status: array<atomic<u32>>;
@group(0) @binding(8) var<storage, read> queries: array<LhbQuery>;
@group(0) @binding(9) var<storage, read_write> hits: array<LhbElement>;

// [1] project: place_of
// [2] walk the list: look_up
@compute @workgroup_size(64)
fn answer_queries(
    @builtin(workgroup_id) workgroup: vec3<u32>,
    @builtin(num_workgroups) workgroups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
) {
    let index = invocation_index(workgroup, workgroups, lane, WORKGROUP_SIZE);
    if index >= params.query_count {
        return;
    }
    hits[index] = look_up(queries[index]);
    if !loops_run(params.loop_rounds) {
        atomicStore(&status[0], 1u);
    }
}
