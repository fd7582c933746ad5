//! Arms on which the search for self-motion manifolds is tested: published redundant designs,
//! industrial arms with spherical wrists, planar arms and one with a prismatic joint.

use faultspace::design::{
    Convention, Geometry, Joint, JointKind, Link, PhysicalLimits, Robot, TaskSpace,
};
use faultspace::kinematics::Chain;
use nalgebra::Isometry3;
use rand::Rng;
use std::f64::consts::{FRAC_PI_2, PI};

/// An arm with one degree of redundancy for its task.
pub struct Arm {
    pub name: &'static str,
    pub chain: Chain,
    pub task: TaskSpace,
}

impl Arm {
    fn new(name: &'static str, robot: &Robot, task: TaskSpace) -> Arm {
        let chain = Chain::new(robot).expect("limits on prismatic joints");
        Arm { name, chain, task }
    }

    /// Joints drawn uniformly, prismatic ones within their stroke.
    pub fn random_joints(&self, rng: &mut impl Rng) -> Vec<f64> {
        let draw = |joint: &faultspace::kinematics::ChainJoint| match joint.turn {
            0.0 => rng.random_range(-FRAC_PI_2..FRAC_PI_2),
            _ => rng.random_range(-PI..PI),
        };
        self.chain.joints.iter().map(draw).collect()
    }

    /// A reachable tool pose: joints drawn uniformly.
    pub fn random_pose(&self, rng: &mut impl Rng) -> Isometry3<f64> {
        self.chain.tool(&self.random_joints(rng))
    }
}

/// Rows of (twist in degrees, length, offset), revolute.
pub fn rows(convention: Convention, rows: &[[f64; 3]]) -> Robot {
    let joint = |&[twist, length, offset]: &[f64; 3]| Joint {
        kind: JointKind::Revolute,
        link: Link {
            twist: twist.to_radians(),
            length,
            offset,
            angle: 0.0,
        },
    };
    Robot {
        name: "rows".into(),
        source: None,
        geometry: Geometry::Rows {
            convention,
            joints: rows.iter().map(joint).collect(),
        },
        physical_limits: None,
        tool: nalgebra::Isometry3::identity(),
    }
}

/// An arm in the plane.
pub fn planar(lengths: &[f64]) -> Robot {
    Robot {
        name: "planar".into(),
        source: None,
        geometry: Geometry::Planar {
            lengths: lengths.to_vec(),
        },
        physical_limits: None,
        tool: nalgebra::Isometry3::identity(),
    }
}

/// Turning column, sliding column, two-link forearm.
pub fn sliding() -> Robot {
    let table = [
        [90.0, 0.2, 0.3],
        [60.0, 0.1, 0.0],
        [80.0, 0.5, 0.1],
        [0.0, 0.4, 0.0],
    ];
    let mut robot = rows(Convention::Standard, &table);
    if let Geometry::Rows { joints, .. } = &mut robot.geometry {
        joints[1].kind = JointKind::Prismatic;
    }
    robot.physical_limits = Some(PhysicalLimits {
        lower: vec![-PI, 0.2, -PI, -PI],
        upper: vec![PI, 0.9, PI, PI],
    });
    robot
}

/// The spatial 4R arm of Clark & Xie 2025, with the published digits.
#[allow(clippy::approx_constant, reason = "published digits")]
pub fn spatial_4r() -> Robot {
    rows(
        Convention::Standard,
        &[
            [90.0, 1.4142, 0.0],
            [-90.0, 1.4142, 1.0],
            [90.0, 1.4142, -1.0],
            [0.0, 1.2247, 0.5],
        ],
    )
}

/// The 7R arm of Bader & Maciejewski 2021.
pub fn bader_7r() -> Robot {
    rows(
        Convention::Standard,
        &[
            [-98.0, 0.17, 0.0],
            [-114.0, 1.42, 1.67],
            [-66.0, 1.42, -0.69],
            [50.0, 0.56, -1.77],
            [-92.0, 1.32, 2.42],
            [-93.0, 1.27, -0.38],
            [0.0, 1.0, 0.95],
        ],
    )
}

/// The 7R arm of Clark & Xie 2025, twists in radians there.
pub fn clark_7r() -> Robot {
    let table = [
        [-1.7104, 0.17, 0.0],
        [-1.9897, 1.42, 1.67],
        [-1.1519, 1.42, -0.69],
        [0.8726, 0.56, -1.77],
        [-1.6057, 1.32, 2.42],
        [-1.6150, 1.27, -0.38],
        [0.0, 0.0, 0.95],
    ];
    let degrees = table.map(|[twist, a, d]: [f64; 3]| [twist.to_degrees(), a, d]);
    rows(Convention::Standard, &degrees)
}

/// The 8R arm of Bader & Maciejewski 2021.
pub fn bader_8r() -> Robot {
    rows(
        Convention::Standard,
        &[
            [71.0, -0.89, 0.0],
            [16.0, 1.41, -2.52],
            [63.0, -1.17, 2.35],
            [125.0, -1.46, 1.09],
            [82.0, -0.66, -1.83],
            [46.0, 1.56, 0.61],
            [108.0, -0.67, 1.56],
            [0.0, 1.0, 1.21],
        ],
    )
}

/// Mitsubishi PA-10: spherical shoulder and wrist.
pub fn pa10() -> Robot {
    rows(
        Convention::Standard,
        &[
            [-90.0, 0.0, 0.0],
            [90.0, 0.0, 0.0],
            [-90.0, 0.0, 0.45],
            [90.0, 0.0, 0.0],
            [-90.0, 0.0, 0.50],
            [90.0, 0.0, 0.0],
            [0.0, 0.0, 0.45],
        ],
    )
}

/// KUKA LBR iiwa 14: spherical shoulder and wrist.
pub fn iiwa() -> Robot {
    rows(
        Convention::Standard,
        &[
            [-90.0, 0.0, 0.36],
            [90.0, 0.0, 0.0],
            [90.0, 0.0, 0.42],
            [-90.0, 0.0, 0.0],
            [-90.0, 0.0, 0.40],
            [90.0, 0.0, 0.0],
            [0.0, 0.0, 0.126],
        ],
    )
}

/// Franka Panda with its flange: spherical shoulder, offset elbow and wrist.
pub fn panda() -> Robot {
    rows(
        Convention::Modified,
        &[
            [0.0, 0.0, 0.333],
            [-90.0, 0.0, 0.0],
            [90.0, 0.0, 0.316],
            [90.0, 0.0825, 0.0],
            [-90.0, -0.0825, 0.384],
            [90.0, 0.0, 0.0],
            [90.0, 0.088, 0.107],
        ],
    )
}

/// Kinova Gen3: small offsets at shoulder and elbow.
pub fn gen3() -> Robot {
    rows(
        Convention::Standard,
        &[
            [90.0, 0.0, -0.2848],
            [90.0, 0.0, -0.0118],
            [90.0, 0.0, -0.4208],
            [90.0, 0.0, -0.0128],
            [90.0, 0.0, -0.3143],
            [90.0, 0.0, 0.0],
            [180.0, 0.0, -0.1674],
        ],
    )
}

/// Every arm.
pub fn all() -> Vec<Arm> {
    use TaskSpace::{PlanarPose, PlanarPosition, SpatialPose, SpatialPosition};
    let held = |name, joint, value| Arm {
        name,
        chain: Chain::new(&bader_8r())
            .expect("revolute")
            .locked(joint, value),
        task: SpatialPose,
    };
    vec![
        Arm::new("planar 3R, equal links", &planar(&[1.0; 3]), PlanarPosition),
        Arm::new("planar 3R", &planar(&[1.0, 0.8, 0.45]), PlanarPosition),
        Arm::new(
            "planar 4R pose, equal links",
            &planar(&[1.0; 4]),
            PlanarPose,
        ),
        Arm::new("planar 4R pose", &planar(&[1.0, 0.9, 0.6, 0.3]), PlanarPose),
        Arm::new("spatial 4R", &spatial_4r(), SpatialPosition),
        Arm::new("R-P-R-R", &sliding(), SpatialPosition),
        Arm::new("7R, Bader", &bader_7r(), SpatialPose),
        Arm::new("7R, Clark", &clark_7r(), SpatialPose),
        held("8R, joint 3 held", 2, 0.5),
        held("8R, joint 6 held", 5, -1.2),
        Arm::new("PA-10", &pa10(), SpatialPose),
        Arm::new("iiwa 14", &iiwa(), SpatialPose),
        Arm::new("Panda", &panda(), SpatialPose),
        Arm::new("Gen3", &gen3(), SpatialPose),
    ]
}
