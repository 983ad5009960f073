// Dispatches of any size, and loops that end early.

// Index of an invocation in a dispatch whose workgroups may be folded into rows.
fn invocation_index(workgroup: vec3<u32>, workgroups: vec3<u32>, lane: u32, workgroup_size: u32) -> u32 {
    return (workgroup.y * workgroups.x + workgroup.x) * workgroup_size + lane;
}

// Whether a loop still runs as often as it should. llvmpipe (Mesa 22.3) ends every loop of an invocation once they have
// taken 65535 rounds in all, silently; asked last, this tells. `rounds` comes from a buffer, so that no compiler knows
// the answer.
fn loops_run(rounds: u32) -> bool {
    var done = 0u;
    for (var i = 0u; i < rounds; i++) {
        done += 1u;
    }
    return done == rounds;
}
