//! Where the turtle goes and what it draws.

use bioscope_core::Vec3;
use bioscope_lsystem::{Interpretation, LSystem, Turtle, TurtleOptions};
use proptest::prelude::*;

fn interpret_with(word: &str, options: &TurtleOptions) -> Interpretation {
    let text = format!("axiom: {word}\nZ --> Z");
    let system = LSystem::parse(&text, "test.l").unwrap_or_else(|reports| panic!("{reports}"));
    Turtle::interpret(&system.derive(0, 0).unwrap(), options).unwrap()
}

fn interpret(word: &str) -> Interpretation {
    interpret_with(word, &TurtleOptions::default())
}

fn end(word: &str) -> Vec3 {
    interpret(word).segments.last().unwrap().end
}

fn assert_near(place: Vec3, expected: [f32; 3]) {
    assert!(place.distance(Vec3::from_array(expected)) < 1e-5, "{place} is not {expected:?}");
}

/// The signs of section 3.6 of the course notes' model: H up, L to −X, U to +Z.
#[test]
fn turns_have_the_signs_of_the_source() {
    assert_near(end("F(2)"), [0.0, 2.0, 0.0]);
    assert_near(end("+(90)F(1)"), [-1.0, 0.0, 0.0]);
    assert_near(end("-(90)F(1)"), [1.0, 0.0, 0.0]);
    assert_near(end("&(90)F(1)"), [0.0, 0.0, -1.0]);
    assert_near(end("^(90)F(1)"), [0.0, 0.0, 1.0]);
    assert_near(end("/(90)+(90)F(1)"), [0.0, 0.0, -1.0]);
    assert_near(end("\\(90)+(90)F(1)"), [0.0, 0.0, 1.0]);
    assert_near(end("|F(1)"), [0.0, -1.0, 0.0]);
    let literature = TurtleOptions { slash_rolls_right: true, ..TurtleOptions::default() };
    let rolled = interpret_with("/(90)+(90)F(1)", &literature);
    assert_near(rolled.segments[0].end, [0.0, 0.0, 1.0]);
}

/// The course notes' query example: after `F(1)`, `-` by 90° and `F(1)` the turtle is at (1, 1).
#[test]
fn the_query_example_of_the_course_notes() {
    assert_near(end("F(1)-(90)F(1)"), [1.0, 1.0, 0.0]);
}

#[test]
fn without_parameters_the_options_count() {
    let options = TurtleOptions { step: 3.0, angle: 90.0, width: 1.0, ..TurtleOptions::default() };
    let drawn = interpret_with("F!F+#F", &options);
    assert_near(drawn.segments[2].end, [-3.0, 6.0, 0.0]);
    let widths: Vec<f32> = drawn.segments.iter().map(|segment| 2.0 * segment.end_radius).collect();
    assert!(widths.iter().zip([1.0, 0.99, 1.0]).all(|(a, b)| (a - b).abs() < 1e-6), "{widths:?}");
}

#[test]
fn brackets_bring_back_the_whole_state() {
    let drawn = interpret("F(1)[+(90)!(3);(5)F(1)]F(1)");
    assert_near(drawn.segments[2].end, [0.0, 2.0, 0.0]);
    assert_eq!(drawn.segments[2].end_radius, drawn.segments[0].end_radius);
    assert_eq!((drawn.segments[1].color, drawn.segments[2].color), (5, 1));
    assert_eq!((drawn.segments[1].depth, drawn.segments[2].depth), (1, 0));
}

#[test]
fn segments_form_axes() {
    let drawn = interpret("F[+F[-F]F]F f F");
    let axes: Vec<u32> = drawn.segments.iter().map(|segment| segment.axis).collect();
    assert_eq!(axes, [0, 1, 2, 1, 0, 3]);
    let parents: Vec<_> =
        drawn.axes.iter().map(|axis| axis.parent.map(|a| (a.axis, a.node))).collect();
    assert_eq!(parents, [None, Some((0, 1)), Some((1, 1)), Some((0, 2))]);
}

#[test]
fn width_and_color_change_along_an_axis() {
    let drawn = interpret("!(4);(2)F!(2);(3)F");
    let second = &drawn.segments[1];
    assert_eq!((second.start_radius, second.end_radius), (2.0, 1.0));
    assert_eq!((second.start_color, second.color), (2, 3));
    let begun = interpret("!(4)@Gs!(0)F");
    assert_eq!((begun.segments[0].start_radius, begun.segments[0].end_radius), (2.0, 0.0));
}

#[test]
fn polygons_surfaces_and_balls() {
    let drawn = interpret("{.f(1)+(90)f(1)+(90)f(1)}~l(2)@O(0.5){.}");
    assert_eq!(drawn.polygons.len(), 1);
    assert_eq!(drawn.polygons[0].corners.len(), 4);
    assert_near(drawn.polygons[0].corners[2], [-1.0, 1.0, 0.0]);
    assert_eq!((drawn.surfaces[0].name, drawn.surfaces[0].scale), ('l', Vec3::splat(2.0)));
    assert_eq!(drawn.balls[0].radius, 0.5);
    assert!(drawn.segments.is_empty());
}

#[test]
fn tropism_bends_the_way_down() {
    let drawn = interpret(&format!("+(60)@Td(0,-1,0)@Ts(0.2){}", "F(0.1)".repeat(40)));
    let heading =
        |index: usize| (drawn.segments[index].end - drawn.segments[index].start).normalize().y;
    assert!((1..40).all(|index| heading(index) < heading(index - 1) + 1e-6));
    assert!(heading(39) < -0.99, "{}", heading(39));
}

#[test]
fn what_is_no_number_leads_nowhere() {
    let drawn = interpret("F(1)+(log(0))F(sqrt(0-1))F(exp(9999))F(1)");
    assert!(drawn.segments.iter().all(|segment| segment.end.is_finite()));
    assert_near(drawn.segments.last().unwrap().end, [0.0, 2.0, 0.0]);
}

#[test]
fn endless_nesting_is_refused() {
    let text = format!("axiom: {}\nZ --> Z", "[".repeat(100_001));
    let string = LSystem::parse(&text, "deep.l").unwrap().derive(0, 0).unwrap();
    let error = Turtle::interpret(&string, &TurtleOptions::default()).unwrap_err();
    assert!(error.to_string().contains("depth of brackets"), "{error}");
}

proptest! {
    /// After any turns a further `F`, `+F` and `&F` are still perpendicular and of unit length.
    #[test]
    fn the_frame_stays_orthonormal(turns in prop::collection::vec((0usize..6, -400f32..400.0), 0..300)) {
        let turns: String = turns
            .iter()
            .map(|&(turn, angle)| format!("{}({angle})", ["+", "-", "&", "^", "/", "\\"][turn]))
            .collect();
        let probe = interpret(&format!("{turns}[F(1)][+(90)F(1)][^(90)F(1)]"));
        let axes: Vec<Vec3> = probe.segments.iter().map(|segment| segment.end).collect();
        for axis in &axes {
            prop_assert!((axis.length() - 1.0).abs() < 1e-5);
        }
        prop_assert!(axes[0].cross(axes[1]).distance(axes[2]) < 1e-5);
    }
}
