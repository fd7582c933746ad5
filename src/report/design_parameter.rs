//! The numbers that make a robot, as figures name them.

use super::number::subscript;

/// One number of a robot: a Denavit–Hartenberg parameter or an artificial limit of a joint, whose
/// number counts from 1.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum DesignParameter {
    /// Length l of a planar robot's link.
    Link(usize),
    /// Length a along x.
    Length(usize),
    /// Offset d along z.
    Offset(usize),
    /// Twist α about x.
    Twist(usize),
    /// Angle θ about z of a prismatic joint.
    Angle(usize),
    /// Lower artificial limit.
    LowerLimit(usize),
    /// Upper artificial limit.
    UpperLimit(usize),
}

impl DesignParameter {
    /// As in a figure: "a₂", "α₃", "θ₄ upper".
    pub fn label(self) -> String {
        match self {
            DesignParameter::Link(link) => format!("l{}", subscript(link)),
            DesignParameter::Length(joint) => format!("a{}", subscript(joint)),
            DesignParameter::Offset(joint) => format!("d{}", subscript(joint)),
            DesignParameter::Twist(joint) => format!("α{}", subscript(joint)),
            DesignParameter::Angle(joint) => format!("θ{}", subscript(joint)),
            DesignParameter::LowerLimit(joint) => format!("θ{} lower", subscript(joint)),
            DesignParameter::UpperLimit(joint) => format!("θ{} upper", subscript(joint)),
        }
    }

    /// As in a table: "a_2", "alpha_3", "upper_limit_4".
    pub fn name(self) -> String {
        match self {
            DesignParameter::Link(link) => format!("l_{link}"),
            DesignParameter::Length(joint) => format!("a_{joint}"),
            DesignParameter::Offset(joint) => format!("d_{joint}"),
            DesignParameter::Twist(joint) => format!("alpha_{joint}"),
            DesignParameter::Angle(joint) => format!("theta_{joint}"),
            DesignParameter::LowerLimit(joint) => format!("lower_limit_{joint}"),
            DesignParameter::UpperLimit(joint) => format!("upper_limit_{joint}"),
        }
    }

    /// Whether it is an artificial limit.
    pub fn is_limit(self) -> bool {
        use DesignParameter::{LowerLimit, UpperLimit};
        matches!(self, LowerLimit(_) | UpperLimit(_))
    }
}
