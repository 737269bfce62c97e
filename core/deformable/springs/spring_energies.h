#pragma once

#include <Eigen/Core>
#include <array>

namespace haptrial::deformable {

/// kExact: the negative gradient of the energies below. kPrinted: the directions that the source
/// prints for areas and volumes, unit vectors, for comparison only: they do not sum to zero, so
/// momentum leaks. Signs and magnitudes of kPrinted are mended so that it pulls back and rests at
/// the rest shape, and scaled so that regular triangles and tetrahedra get the forces of kExact.
enum class ForceForm { kExact, kPrinted };

/// One spring: a constant and the rest length, area or volume.
struct Spring {
  double constant{};  // k >= 0 [J]
  double rest{};      // L0, A0 or V0 > 0 [m], [m²], [m³]
};

using Points2 = std::array<Eigen::Vector3d, 2>;
using Points3 = std::array<Eigen::Vector3d, 3>;
using Points4 = std::array<Eigen::Vector3d, 4>;

/// The three energies of Teschner et al. 2004 (A versatile and robust model for geometrically
/// complex deformable solids), each of a dimensionless strain, so that every constant is an energy:
///
///     E = k/2 ((l - L0) / L0)²   l  length of an edge
///     E = k/2 ((A - A0) / A0)²   A  area of a face, half of |a x b|
///     E = k/2 ((V - V0) / V0)²   V  signed volume of a tetrahedron, positive at rest
///
/// A force of the printed forms with the constants k_d, k_a and k_v of another program is that of
/// k = k_d L0² here for a length, in [J].
/// Points [m], energies [J].
/// Source: Morris 2006, §5.4.1.
double length_energy(const Spring& spring, const Points2& points);
double area_energy(const Spring& spring, const Points3& points);
double volume_energy(const Spring& spring, const Points4& points);

/// The force on each point [N]. A length or an area that is 0 has no direction: its force is 0.
Points2 length_forces(const Spring& spring, const Points2& points);  // both forms are the same
Points3 area_forces(const Spring& spring, const Points3& points, ForceForm form);
Points4 volume_forces(const Spring& spring, const Points4& points, ForceForm form);

/// Measures and their gradients.
double area_of(const Points3& points);           // [m²]
Points3 area_gradient(const Points3& points);    // [m]; 0 for a flat triangle
double volume_of(const Points4& points);         // [m³], signed
Points4 volume_gradient(const Points4& points);  // [m²]

}  // namespace haptrial::deformable
