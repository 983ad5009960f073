//! `plan`: what a render would simulate.

use crate::args::PlanArgs;
use crate::exit::Failure;
use crate::render::Job;
use crate::report;
use crate::source;
use serde_json::{Value, json};
use std::fmt::Write as _;
use twinlight::methods::plan::{Decision, Dispatches, Facts, Plan, Sight, Step};

/// Runs the command.
///
/// # Errors
/// Those of reading scenes, and of flags that don't fit them.
pub fn run(args: &PlanArgs) -> Result<(), Failure> {
    let picture = &args.picture;
    let loaded = source::load(&picture.scene, &picture.load, picture.camera.map(|c| c.0))?;
    let prepared = loaded.at(args.at.unwrap_or(0.0))?;
    prepared.notices.iter().for_each(|text| report::notice(text));
    let job = Job::new(picture, None, &prepared)?;
    let text =
        if args.json { format!("{:#}\n", json(&picture.scene, &job.plan)) } else { text(args, &job.plan) };
    report::print(&text)
}

fn text(args: &PlanArgs, plan: &Plan) -> String {
    let mut text = headline(args, plan);
    // Writing to a string can't fail.
    for decided in &plan.effects {
        let lost = match decided.decision {
            Decision::Run => String::new(),
            _ => lost(decided.bound),
        };
        let (effect, decision) = (decided.effect.to_string(), decided.decision.to_string());
        let _ = writeln!(text, "{effect:16} {decision:8} {lost:>9}  {}", decided.reason);
    }
    let _ = writeln!(text, "\n{}", conclusion(plan));
    if args.explain {
        explain(plan, &mut text);
    }
    text
}

fn headline(args: &PlanArgs, plan: &Plan) -> String {
    let (picture, request) = (&plan.request.picture, &plan.request);
    format!(
        "{}: {} triangles, {}x{} pixels, {} samples, method {}, effects {}, tolerance {:.3e}\n\n{:16} {:8} {:>9}  why\n",
        args.picture.scene,
        plan.facts.triangles,
        picture.width,
        picture.height,
        picture.samples,
        request.method.name(),
        request.effects,
        request.tolerance,
        "effect",
        "decision",
        "at most",
    )
}

/// Radiance that is lost, in three digits.
fn lost(bound: f64) -> String {
    if bound == 0.0 {
        "0".into()
    } else if bound.is_infinite() {
        "unknown".into()
    } else {
        format!("{bound:.2e}")
    }
}

fn conclusion(plan: &Plan) -> String {
    let bounces =
        plan.bounces.map_or("as often as roulette lets it".into(), |n| format!("{n} times at most"));
    format!(
        "light is scattered {bounces}; a pixel lacks at most {} of what the method can simulate",
        lost(plan.bound())
    )
}

fn explain(plan: &Plan, text: &mut String) {
    let facts = &plan.facts;
    let _ = writeln!(text, "\nscene");
    for (name, value) in properties(facts) {
        let _ = writeln!(text, "  {name:22} {value}");
    }
    let _ =
        writeln!(text, "\n  {:16} {:>9} {:>12} {:16} {:>10}  for", "kernel", "calls", "work", "", "writes");
    for step in &plan.steps {
        let (calls, bytes) = (calls(step), report::bytes(step.bytes));
        let _ = writeln!(
            text,
            "  {:16} {calls:>9} {:>12} {:16} {bytes:>10}  {}",
            step.kernel,
            magnitude(step.work),
            step.unit,
            step.purpose
        );
    }
}

fn properties(facts: &Facts) -> [(&'static str, String); 8] {
    let sight = match facts.sight {
        Sight::None(why) => format!("no: {why}"),
        Sight::Some(why) => format!("yes: {why}"),
        Sight::Unknown(why) => format!("unknown: {why}"),
    };
    let direct = if facts.direct.is_infinite() { "unknown".into() } else { format!("{:.4}", facts.direct) };
    let environment = if facts.environment { " and an environment" } else { "" };
    [
        ("triangles", format!("{}, {} of them move", facts.triangles, facts.moving)),
        (
            "lights",
            format!("{} with an extent, {} without{environment}", facts.area_lights, facts.delta_lights),
        ),
        ("glossy, mirror, glass", format!("{}, {}, {} triangles", facts.glossy, facts.mirrors, facts.glass)),
        ("textured", format!("{} triangles", facts.textured)),
        ("reflectance, at most", format!("{:.4}: {}", facts.reflectance, facts.brightest_surface)),
        ("mean albedo", format!("{:.4}", facts.mean_albedo)),
        ("white surface, at most", format!("{direct} of radiance from the lights alone")),
        ("surfaces see surfaces", sight),
    ]
}

fn calls(step: &Step) -> String {
    match step.dispatches {
        Dispatches::Exactly(count) => count.to_string(),
        Dispatches::AtMost(count) => format!("<= {count}"),
        Dispatches::Passes => "passes".into(),
    }
}

fn magnitude(count: f64) -> String {
    match count {
        c if c >= 1e9 => format!("{:.1} G", c / 1e9),
        c if c >= 1e6 => format!("{:.1} M", c / 1e6),
        c if c >= 1e3 => format!("{:.1} k", c / 1e3),
        c => format!("{c:.0}"),
    }
}

/// The decisions, for machines. What is infinite is null.
pub fn effects_json(plan: &Plan) -> Value {
    let effects = plan.effects.iter().map(|decided| {
        json!({
            "effect": decided.effect.to_string(),
            "decision": decided.decision.to_string(),
            "bound": decided.bound,
            "reason": decided.reason,
        })
    });
    json!({ "effects": effects.collect::<Vec<_>>(), "bounces": plan.bounces, "bound": plan.bound() })
}

fn json(scene: &str, plan: &Plan) -> Value {
    let facts = &plan.facts;
    let steps = plan.steps.iter().map(|step| {
        json!({
            "kernel": step.kernel, "purpose": step.purpose, "calls": calls(step), "work": step.work,
            "unit": step.unit, "bytes": step.bytes,
        })
    });
    json!({
        "twinlight": env!("CARGO_PKG_VERSION"),
        "scene": scene,
        "method": plan.request.method.name(),
        "wanted": plan.request.effects.to_string(),
        "tolerance": plan.request.tolerance,
        "plan": effects_json(plan),
        "facts": {
            "triangles": facts.triangles, "moving": facts.moving, "area_lights": facts.area_lights,
            "delta_lights": facts.delta_lights, "environment": facts.environment, "glossy": facts.glossy,
            "mirrors": facts.mirrors, "glass": facts.glass, "textured": facts.textured,
            "reflectance": facts.reflectance, "mean_albedo": facts.mean_albedo, "direct": facts.direct,
            "surfaces_see_surfaces": !matches!(facts.sight, Sight::None(_)),
        },
        "steps": steps.collect::<Vec<_>>(),
    })
}
