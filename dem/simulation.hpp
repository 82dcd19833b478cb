#pragma once
// Equal spheres in a box with moving triangle-mesh bodies: leapfrog (velocity Verlet) with a Verlet list.
//
//   v(n+1/2) = v(n-1/2) + F(n)/m dt,  x(n+1) = x(n) + v(n+1/2) dt,  v*(n+1) = v(n+1/2) + F(n)/(2m) dt
// Forces at n+1 see v*(n+1), the velocity extrapolated to that time, instead of the half-step velocity of plain
// velocity Verlet, which makes the dashpot second order between contact events. Spins alike with inertia 2/5 m r^2.
#include <array>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <variant>
#include <vector>

#include "dem/contact_law.hpp"
#include "dem/mesh.hpp"
#include "dem/motion.hpp"
#include "dem/state.hpp"
#include "dem/team.hpp"

namespace dem {

/// A rigid body whose surface the spheres meet; the mesh is given before the motion.
struct Body {
  std::string name;
  TriangleMesh mesh;  ///< m, welded; with its periodic copies where the box is periodic
  Motion motion;
};

struct Spheres {
  double radius = 0.0;               ///< m
  double density = 0.0;              ///< kg/m3
  std::vector<std::uint8_t> frozen;  ///< 1: does not move, keeping its mass in contacts; empty: none
  std::vector<Vec3> position;        ///< m
  std::vector<Vec3> velocity;        ///< m/s, empty: at rest
  std::vector<Vec3> spin;            ///< rad/s, empty: none
};

using AnyLaw = std::variant<LinearLaw<false, NoAttraction>, LinearLaw<false, VanDerWaals>,
                            LinearLaw<true, NoAttraction>, LinearLaw<true, VanDerWaals>>;

struct Setup {
  Vec3 low, high;  ///< m, the box; a particle beyond it ends the run
  std::array<bool, 3> periodic{true, false, false};
  Spheres spheres;
  std::vector<Body> bodies;
  AnyLaw grain;                   ///< law between spheres
  AnyLaw wall;                    ///< the same alternative, for sphere and body
  Vec3 gravity{0.0, 0.0, -9.81};  ///< m/s2
  double time_step = 0.0;         ///< s
  double skin = 0.0;              ///< m
  std::uint64_t rest_steps = 0;   ///< before the bodies' motions begin
  int threads = 1;
};

/// Load of the powder on a body.
struct BodyLoad {
  Vec3 force;   ///< N
  Vec3 torque;  ///< N m about the motion's point, where it is now; arms from there to the contact point
};
inline constexpr std::size_t max_bodies = 4;

/// Sums over one step's contacts.
struct StepSums {
  BodyLoad body[max_bodies];
  double virial = 0.0;         ///< J, sum over sphere contacts of push * distance of the centres
  std::uint64_t contacts = 0;  ///< pairs of spheres that overlap
  std::uint64_t wall_contacts = 0;
  std::uint64_t deep = 0;    ///< contacts whose overlap is more than 10 % of a radius
  double max_overlap = 0.0;  ///< of a radius
};

/// The run cannot go on: what, where, when and the likely cause.
struct Fault : std::runtime_error {
  using std::runtime_error::runtime_error;
};

class Simulation {
 public:
  explicit Simulation(Setup setup);

  /// One time step. Throws Fault.
  void step();

  const Setup& setup() const { return setup_; }
  const State& state() const { return state_; }
  void restore(State state);
  double time() const { return static_cast<double>(state_.step) * setup_.time_step; }  ///< s
  double mass() const { return mass_; }                                                ///< kg, of one sphere
  double inertia() const { return inertia_; }                                          ///< kg m2
  const StepSums& sums() const { return sums_; }
  double kinetic_energy() const;  ///< J, translation and rotation
  Vec3 momentum() const;          ///< kg m/s
  /// Velocities at the time of the positions, exact to the integrator's order.
  MotionRow motion(std::size_t particle) const;

 private:
  template <class Law>
  void contacts(const Law& grain, const Law& wall);
  void compute_forces();
  void integrate();
  double motion_time(std::uint64_t step) const;  ///< s since the motions began
  bool list_is_stale() const;
  void rebuild();
  void wrap();
  void list_walls(const std::vector<std::uint32_t>& place);
  void index_partners();

  Setup setup_;
  State state_;
  std::vector<Surface> surface_;
  std::vector<Reach> body_reach_;  ///< of its surface and a sphere's radius
  double mass_ = 0.0, inertia_ = 0.0, range_ = 0.0;
  std::array<VectorRow, 27> image_;  ///< m, added to the partner's position
  double max_displacement2_ = 0.0;   ///< m2
  StepSums sums_;
  std::vector<StepSums> block_sums_;
  std::vector<double> block_displacement2_;
  // several threads only: what each slot does, and the slots in which a particle is the partner
  struct SlotLoad {
    VectorRow force, torque_i, torque_j;
  };
  std::vector<SlotLoad> slot_load_;
  std::vector<std::uint32_t> reverse_first_, reverse_;
  std::vector<LoadRow> wall_load_;
  Team team_;
};

}  // namespace dem
