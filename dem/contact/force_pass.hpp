#pragma once
// The forces of one step, chunk by chunk. A ForcePass knows the contact laws; it is called once per chunk and step.
#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "dem/contact/contact_law.hpp"
#include "dem/contact/state.hpp"
#include "dem/walls/motion.hpp"

namespace dem {

inline constexpr std::size_t max_bodies = 8;

/// Load of the powder on a body, and how the powder slips on it.
struct BodyLoad {
  Vec3 force;         ///< N
  Vec3 torque;        ///< N m about the present place of the motion's point; arms go from there to the contact point
  double slip = 0.0;  ///< m/s, sum over the contacts of the speed at which the surfaces slip
  std::uint64_t contacts = 0;  ///< touching spheres; one that touches two parts of the surface counts twice
};

/// Sums over one step's contacts.
struct StepSums {
  std::array<BodyLoad, max_bodies> body;
  double virial = 0.0;         ///< J, sum over sphere contacts of push * distance of the centres
  double dissipated = 0.0;     ///< J in this step, by dashpots, sliding and contacts that break
  double tool_work = 0.0;      ///< J in this step, work of the bodies on the spheres
  std::uint64_t contacts = 0;  ///< pairs of spheres that touch
  std::uint64_t wall_contacts = 0;
  std::uint64_t deep = 0;    ///< contacts whose overlap is more than Surroundings::deep
  double max_overlap = 0.0;  ///< largest overlap, as a share of a radius
};

/// A body as this step sees it.
struct Frame {
  Pose now;
  Vec3 point;          ///< m, the motion's point in the body's frame
  double moved = 0.0;  ///< m, how far any point of the body came since the rebuild, at most
};

/// What the forces of a step need beside the state.
struct Surroundings {
  std::span<const Surface> surfaces;  ///< per body
  std::span<const Frame> frames;
  double time_step;        ///< s
  double range;            ///< m
  double deep;             ///< share of a radius; deeper overlaps are counted
  double steps_per_metre;  ///< at least so many until two spheres are nearer to each other by a metre
};

/// Energies [J] at the present positions.
struct ContactEnergy {
  double elastic = 0.0, attraction = 0.0;
};

/// Who meets in a contact that is looked at alone; this decides its law.
enum class Partner { sphere, body };
struct Who {
  Partner partner = Partner::sphere;
  std::size_t material = 0;         ///< of the sphere
  std::size_t other = 0;            ///< material of the partner, or the body
  double mass = 0.0, radius = 0.0;  ///< kg, m, reduced
};

class ForcePass {
 public:
  virtual ~ForcePass() = default;
  /// How far [m] beyond touching the laws reach for spheres up to this radius.
  virtual double range(double largest_radius) const = 0;
  virtual int history_rows() const = 0;
  /// Adds the loads of the chunk's pairs and wall contacts.
  virtual void chunk(State& state, const Surroundings& around, std::size_t chunk, StepSums& sums) const = 0;
  virtual ContactEnergy energy(const State& state, const Surroundings& around) const = 0;
  /// The reaction of one contact by itself.
  virtual Reaction<double> react(const Who& who, const Meeting<double>& meeting, const History<double>& before,
                                 double time_step) const = 0;
  /// The gap [m] up to which a contact, once made, still holds.
  virtual double holds(const Who& who) const = 0;
};

/// The laws of a bed, between two materials and between a material and a body's surface.
template <class Law>
struct LawTables {
  std::vector<Law> grain;  ///< materials x materials, symmetric
  std::vector<Law> wall;   ///< materials x bodies
  int materials = 1;
  double equal_mass = 0.0, equal_radius = 0.0;  ///< kg, m of every sphere; 0 where spheres differ
};

}  // namespace dem
