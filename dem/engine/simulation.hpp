#pragma once
// Spheres in a box with moving triangle-mesh bodies: leapfrog (velocity Verlet) with a Verlet list.
//
//   v(n+1/2) = v(n-1/2) + F(n)/m dt,  x(n+1) = x(n) + v(n+1/2) dt,  v*(n+1) = v(n+1/2) + F(n)/(2m) dt
// Forces at n+1 see v*(n+1), the velocity extrapolated to that time, instead of the half-step velocity of plain
// velocity Verlet, which makes the dashpot second order between contact events. Spins are advanced in
// the same way, with the inertia 2/5 m r^2.
#include <array>
#include <cstdint>
#include <limits>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "dem/contact/force_pass.hpp"
#include "dem/contact/state.hpp"
#include "dem/engine/team.hpp"
#include "dem/walls/mesh.hpp"
#include "dem/walls/motion.hpp"

namespace dem {

/// A rigid body whose surface the spheres meet; the mesh is given before the motion.
struct Body {
  std::string name;
  TriangleMesh mesh;  ///< m, welded; with its periodic copies where the box is periodic
  Motion motion;
};

struct Spheres {
  std::vector<double> radius;           ///< m, one value for all spheres, or one for each
  std::vector<double> density;          ///< kg/m3, one value for all spheres, or one for each
  std::vector<std::uint32_t> material;  ///< index into the laws' tables; empty: all 0
  std::vector<std::uint8_t> frozen;  ///< 1: keeps its velocity whatever the load, and its mass in contacts; empty: none
  std::vector<Vec3> position;        ///< m
  std::vector<Vec3> velocity;        ///< m/s, empty: at rest
  std::vector<Vec3> spin;            ///< rad/s, empty: none
};

/// Two channels side by side, such as those of a machine of two mixers. A plane at `middle` across parts them. A rig
/// without channels has the length 0.
struct Channels {
  Vec3 along{1.0, 0.0, 0.0};              ///< unit, direction in which the powder of the first channel is to flow
  Vec3 across{0.0, 1.0, 0.0};             ///< unit, from the first channel to the second
  double middle = 0.0;                    ///< m along `across`
  double from = 0.0, to = 0.0;            ///< m along `along`, ends of the channels
  double flow_from = 0.0, flow_to = 0.0;  ///< m, part between the openings, where nothing goes from one to the other

  bool exist() const { return to > from; }
  int of(Vec3 at) const { return dot(across, at) < middle ? 0 : 1; }
};

struct Setup {
  Vec3 low, high;  ///< m, the box; a particle beyond it ends the run
  std::array<bool, 3> periodic{true, false, false};
  Spheres spheres;
  std::vector<Body> bodies;
  std::shared_ptr<const ForcePass> laws;
  Vec3 gravity{0.0, 0.0, -9.81};                                   ///< m/s2
  double time_step = 0.0;                                          ///< s
  double skin = 0.0;                                               ///< m
  double overlap_limit = std::numeric_limits<double>::infinity();  ///< share of a radius; a deeper overlap ends the run
  std::uint64_t rest_steps = 0;                                    ///< steps before the bodies' motions begin
  int threads = 1;
  Channels channels;
};

/// The run cannot go on: what happened, where, when and the likely cause.
struct Fault : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Energies [J] at the time of the positions; potentials of gravity count from z = 0.
struct Energy {
  double translation = 0.0, rotation = 0.0, gravity = 0.0, elastic = 0.0, attraction = 0.0;
  double total() const { return translation + rotation + gravity + elastic + attraction; }
};

/// Momentum, energy and flow of all spheres in the last step, at its half, where leapfrog has their velocities.
struct Carried {
  Vec3 momentum;                 ///< kg m/s
  Vec3 moment;                   ///< kg m, sum of mass * position, at the step's end
  double kinetic_energy = 0.0;   ///< J, translation and rotation
  std::array<double, 2> flow{};  ///< kg m/s along Channels::along, of each channel between its openings
};

/// The grid along which rows are sorted: x outermost, z innermost.
struct Cells {
  Vec3 low, size;  ///< m, origin and edge lengths of one cell
  int n[3] = {1, 1, 1};
  std::vector<std::uint32_t> first, ghost_first;  ///< first row of each cell, and one more entry; ghosts count from 0

  std::size_t total() const { return static_cast<std::size_t>(n[0]) * n[1] * n[2]; }
  std::array<int, 3> around(Vec3 at) const;  ///< the cell at a point, or the nearest
  std::uint32_t of(Vec3 at) const;           ///< the number of that cell
};

/// Reserves room for this many rows and a few more; a vector that grows by itself doubles.
template <class Row>
void make_room(std::vector<Row>& rows, std::size_t count) {
  if (rows.capacity() < count) rows.reserve(count + count / 512);
}

class Simulation {
 public:
  explicit Simulation(Setup setup);

  /// One time step. Throws Fault.
  void step();

  const Setup& setup() const { return setup_; }
  const State& state() const { return state_; }
  void restore(State state);
  double time() const { return static_cast<double>(state_.step) * setup_.time_step; }  ///< s
  const StepSums& sums() const { return sums_; }
  const Carried& carried() const { return carried_; }
  double kinetic_energy() const;  ///< J, translation and rotation
  Energy energy() const;
  Vec3 momentum() const;  ///< kg m/s
  /// Velocities at the time of the positions, exact to the integrator's order.
  MotionRow motion(std::size_t particle) const;
  double bytes_per_particle() const;  ///< bytes of state and lists

 private:
  void compute_forces();
  void add_halos();
  void integrate();
  void follow_owners();
  double motion_time(std::uint64_t step) const;  ///< s since the motions began
  bool list_is_stale() const;
  void wake_all();
  void rebuild();
  void wrap();
  void sort();
  void make_ghosts();
  void list_pairs();
  std::vector<std::uint32_t> first_of_each(const std::vector<Pair>& pairs,
                                           const std::vector<std::uint32_t>& chunk_pair);
  std::vector<Pair> pairs_of(std::size_t chunk) const;
  void list_halos();
  void list_walls();
  std::vector<Frame> frames() const;
  Surroundings around(const std::vector<Frame>& frames) const;
  [[noreturn]] void report_overlap() const;

  /// Calls work(i) for every particle, the team sharing the chunks.
  template <class Work>
  void each_particle(Work&& work) {
    team_.for_each(state_.chunks(), [&](std::size_t c) {
      for (std::uint32_t i = state_.chunk_first[c]; i < state_.chunk_first[c + 1]; ++i) work(i);
    });
  }

  Setup setup_;
  State state_;
  std::vector<Surface> surface_;
  std::vector<Reach> body_reach_;   ///< reach of each body's surface and a sphere's radius
  double largest_radius_ = 0.0;     ///< m
  double range_ = 0.0;              ///< m, how far the laws reach beyond touching
  double max_displacement2_ = 0.0;  ///< m2
  double fastest_ = 0.0;            ///< m/s, the fastest sphere in the last step
  double watched_speed_ = 0.0;      ///< m/s, speed that pairs out of range count on while they sleep
  StepSums sums_;
  Carried carried_;
  std::vector<StepSums> chunk_sums_;
  struct ChunkStep {
    double displacement2 = 0.0;  ///< m2, since the rebuild
    double speed2 = 0.0;         ///< m2/s2
    double late_power = 0.0;     ///< W, power of the loads on v*(n) less that on v(n), known only after the forces
    Carried carried;
  };
  std::vector<ChunkStep> chunk_steps_;
  Team team_;

  // Memory that a rebuild uses from step to step, given back at its end but for the ghosts.
  Cells cells_;
  std::vector<Ghost> old_ghosts_;
  std::vector<std::uint32_t> order_, place_;  ///< old row of each new row, and the reverse
};

}  // namespace dem
