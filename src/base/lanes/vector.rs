//! Vectors in lanes.

use std::ops::{Add, Div, Mul, Neg, Sub};

use super::Lanes;
use crate::base::Vec3;

/// A vector in each lane.
#[derive(Clone, Copy, Debug)]
pub struct Vector<L> {
    /// x components.
    pub x: L,
    /// y components.
    pub y: L,
    /// z components.
    pub z: L,
}

impl<L: Lanes> Vector<L> {
    /// From its components.
    #[inline(always)]
    pub fn new(x: L, y: L, z: L) -> Self {
        Self { x, y, z }
    }

    /// The same vector in all lanes.
    #[inline(always)]
    pub fn splat(vector: &Vec3) -> Self {
        Self::new(L::splat(vector.x), L::splat(vector.y), L::splat(vector.z))
    }

    /// Zero in all lanes.
    #[inline(always)]
    pub fn zero() -> Self {
        Self::new(L::splat(0.0), L::splat(0.0), L::splat(0.0))
    }

    /// From columns.
    #[inline(always)]
    pub fn of([x, y, z]: [L; 3]) -> Self {
        Self { x, y, z }
    }

    /// Dot product.
    #[inline(always)]
    pub fn dot(self, other: Self) -> L {
        self.x * other.x + self.y * other.y + self.z * other.z
    }

    /// Cross product.
    #[inline(always)]
    pub fn cross(self, other: Self) -> Self {
        Self::new(
            self.y * other.z - self.z * other.y,
            self.z * other.x - self.x * other.z,
            self.x * other.y - self.y * other.x,
        )
    }

    /// `self` where `mask` is true, else `other`.
    #[inline(always)]
    pub fn or_where(self, mask: L::Mask, other: Self) -> Self {
        Self::new(
            self.x.or_where(mask, other.x),
            self.y.or_where(mask, other.y),
            self.z.or_where(mask, other.z),
        )
    }
}

impl From<Vec3> for Vector<f64> {
    #[inline(always)]
    fn from(vector: Vec3) -> Self {
        Self::new(vector.x, vector.y, vector.z)
    }
}

impl From<Vector<f64>> for Vec3 {
    #[inline(always)]
    fn from(vector: Vector<f64>) -> Self {
        Self::new(vector.x, vector.y, vector.z)
    }
}

impl<L: Lanes> Add for Vector<L> {
    type Output = Self;
    #[inline(always)]
    fn add(self, other: Self) -> Self {
        Self::new(self.x + other.x, self.y + other.y, self.z + other.z)
    }
}

impl<L: Lanes> Sub for Vector<L> {
    type Output = Self;
    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        Self::new(self.x - other.x, self.y - other.y, self.z - other.z)
    }
}

impl<L: Lanes> Mul<L> for Vector<L> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, factor: L) -> Self {
        Self::new(self.x * factor, self.y * factor, self.z * factor)
    }
}

impl<L: Lanes> Div<L> for Vector<L> {
    type Output = Self;
    #[inline(always)]
    fn div(self, divisor: L) -> Self {
        Self::new(self.x / divisor, self.y / divisor, self.z / divisor)
    }
}

impl<L: Lanes> Neg for Vector<L> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        Self::new(-self.x, -self.y, -self.z)
    }
}
