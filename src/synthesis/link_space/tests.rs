use super::*;
use crate::sampling::stream;

fn family(twist: Parameter, n: usize) -> LinkSpace {
    let row = LinkRow {
        twist,
        length: Parameter::Bounded([0.0, 0.5]),
        offset: Parameter::Bounded([-0.5, 0.5]),
    };
    LinkSpace::new(vec![row; n], TaskSpace::SpatialPose)
}

fn right_angles() -> LinkSpace {
    family(Parameter::OneOf(vec![-FRAC_PI_2, FRAC_PI_2]), 7)
}

#[test]
fn random_robots_keep_to_their_bounds_at_reach_1() {
    let space = right_angles();
    for number in 0..50 {
        let links = space.random(&mut stream(1, number));
        let mut confined = links.clone();
        space.confine(&mut confined);
        assert_eq!(links, confined);
        assert!((space.reach(&links) - 1.0).abs() < 1e-3);
        assert!(links[..6].iter().all(|l| l.twist.abs() == FRAC_PI_2));
        assert_eq!(
            (links[0].offset, links[6].length, links[6].twist),
            (0.0, 0.0, 0.0)
        );
    }
}

#[test]
fn coordinates_survive_the_round_trip() {
    let space = family(Parameter::Bounded([-TAU, TAU]), 4);
    let links = space.random(&mut stream(2, 0));
    let variables = space.variables(true);
    // Of twelve, d₁ and the last row are idle; three of the eight left are twists.
    assert_eq!(variables.len(), 8);
    assert_eq!(space.variables(false).len(), 5);
    let x = space.coordinates(&links, &variables);
    let back = space.at(&links, &variables, &x);
    for (a, b) in links.iter().zip(&back) {
        assert!((a.twist - b.twist).abs() < 1e-15 && (a.length - b.length).abs() < 1e-15);
    }
}

/// A larger robot is the same robot.
#[test]
fn settling_divides_by_the_reach() {
    let space = right_angles();
    let links = space.random(&mut stream(3, 0));
    let mut larger = links.clone();
    for link in &mut larger {
        link.length *= 1.1;
        link.offset *= 1.1;
    }
    // Bounds first, then size: what was inside by far comes back.
    let (scale, reach) = space.settle(&mut larger);
    assert!((reach - 1.0).abs() < 1e-3 && scale > 0.9 && scale < 1.2);
}

/// A robot of links has their rows, at the reach that was asked for.
#[test]
fn robots_have_standard_rows() {
    let space = right_angles();
    let links = space.random(&mut stream(4, 0));
    let robot = space.robot(&links, 2.0, "r");
    let back = LinkSpace::links_of(&robot).unwrap();
    assert_eq!(back[1].length, 2.0 * links[1].length);
    let extent = crate::kinematics::workspace_extent(&robot).unwrap();
    assert!((extent.reach - 2.0).abs() < 2e-3);
}
