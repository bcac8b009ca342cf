use super::*;
use crate::experiments::Size;

#[test]
fn prototype() {
    let scene =
        SceneText { text: SCENE_TEXT, source: SCENE_FILE, overrides: &[], size: Size::Quick };
    let plan = Slide.read(&scene).unwrap_or_else(|e| panic!("{e}"));
    let Ok(only) = std::env::var("CASES") else { return };
    let mut records = Vec::new();
    for name in plan.cases() {
        if !only.split(',').any(|it| it == name || it == "all") {
            continue;
        }
        let t = std::time::Instant::now();
        let mut run = plan.start(&name).unwrap();
        loop {
            match run.advance() {
                Ok(p) if p.is_done => break,
                Ok(_) => {}
                Err(e) => {
                    eprintln!("{name}: {e}");
                    break;
                }
            }
        }
        let r = run.record();
        eprintln!("{name}: {:.2} s {:?} {:?}", t.elapsed().as_secs_f64(), r.n_substeps, r.validity);
        records.push(r);
    }
    let f = plan.evaluate(&records);
    for r in &f.rows {
        eprintln!(
            "{} {} measured {:.6e} oracle {:.6e} tol {:.2e} {:?}",
            if r.pass { "ok " } else { "RED" },
            r.id,
            r.measured,
            r.oracle,
            r.tolerance,
            r.relation
        );
    }
    for r in &f.notes {
        eprintln!("note {r}");
    }
}
