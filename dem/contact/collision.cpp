#include "dem/contact/collision.hpp"

#include <cvode/cvode.h>
#include <fmt/format.h>
#include <nvector/nvector_serial.h>
#include <sunlinsol/sunlinsol_dense.h>
#include <sunmatrix/sunmatrix_dense.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <stdexcept>

namespace dem {
namespace {

constexpr double tolerance = 1e-9;
constexpr double patience = 1e3;  // time scales after which a pair that has not parted is said to stick

/// Units in which everything that happens is of order one.
struct Scale {
  double length = 1.0;  ///< m
  double time = 1.0;    ///< s
  double force = 1.0;   ///< N
};

enum class Phase { apart, touching };

/// y: displacement since the start, relative velocity, both spins, slip, roll, twist; all in units of the scale.
constexpr int unknowns = 19;

struct Impact {
  const ForcePass* laws;
  const Encounter* given;
  Who who;
  Vec3 start;    ///< m, from the partner's centre (or the plane) to the sphere's
  double reach;  ///< m, sum of radii (plane: the radius)
  double range;  ///< m, of the laws beyond touching
  double holds;  ///< m, how far apart a contact holds once made
  Scale scale;
  Phase phase = Phase::apart;

  bool wall() const { return !given->partner; }
};

Vec3 vector_at(const double* y) { return {y[0], y[1], y[2]}; }
void put(double* y, Vec3 v) {
  y[0] = v.x;
  y[1] = v.y;
  y[2] = v.z;
}

struct Geometry {
  Vec3 normal;
  double distance, overlap, normal_velocity;
};

Geometry geometry(const Impact& p, const double* y) {
  const Vec3 x = p.start + p.scale.length * vector_at(y);
  const Vec3 v = (p.scale.length / p.scale.time) * vector_at(y + 3);
  Geometry g;
  g.normal = p.wall() ? Vec3{0.0, 0.0, 1.0} : unit(x);
  g.distance = dot(x, g.normal);
  g.overlap = p.reach - g.distance;
  g.normal_velocity = dot(v, g.normal);
  return g;
}

struct Load {
  Reaction<double> reaction;
  Vec3 force, torque, partner_torque;
};

Load load_of(const Impact& p, const double* y, const Geometry& g) {
  const Scale& s = p.scale;
  const double epsilon = 1e-6 * s.time;
  const Ball &a = p.given->sphere, b = p.given->partner.value_or(Ball{});
  const Vec3 spin = (1.0 / s.time) * vector_at(y + 6), partner_spin = (1.0 / s.time) * vector_at(y + 9);
  const double arm = p.wall() ? g.distance : a.radius * g.distance / p.reach;
  const double partner_arm = p.wall() ? 0.0 : b.radius * g.distance / p.reach;
  // Each side of a jump keeps its own law: apart the overlap stays negative, touching it does not go below what holds.
  const bool touching = p.phase == Phase::touching;
  const double least = 1e-12 * s.length;
  const auto clipped = [&](double overlap) {
    return touching ? std::max(overlap, p.holds > 0.0 ? -p.holds * (1.0 - 1e-12) : least) : std::min(overlap, -least);
  };
  Meeting<double> m{g.normal, clipped(g.overlap),
                    (s.length / s.time) * vector_at(y + 3) - cross(arm * spin + partner_arm * partner_spin, g.normal),
                    spin - partner_spin};
  History<double> h{s.force * vector_at(y + 12), 0.0, s.force * vector_at(y + 15), s.force * p.who.radius * y[18]};
  if (touching) {
    // The contact radius a short step ago, for laws that scale with its change. Any positive one says that it holds.
    History<double> held;
    held.radius = 1.0;
    Meeting<double> ago = m;
    ago.overlap = clipped(m.overlap + g.normal_velocity * epsilon);
    h.radius = p.laws->react(p.who, ago, held, 0.0).history.radius;
  }
  Load l;
  l.reaction = p.laws->react(p.who, m, h, epsilon);
  const Vec3 moment = cross(g.normal, l.reaction.tangential);
  l.force = l.reaction.push * g.normal + l.reaction.tangential;
  l.torque = l.reaction.couple - arm * moment;
  l.partner_torque = -l.reaction.couple - partner_arm * moment;
  return l;
}

int right_hand_side(double, N_Vector state, N_Vector rate, void* data) {
  const Impact& p = *static_cast<const Impact*>(data);
  const double* y = N_VGetArrayPointer(state);
  double* dy = N_VGetArrayPointer(rate);
  const Scale& s = p.scale;
  const Load l = load_of(p, y, geometry(p, y));
  put(dy, vector_at(y + 3));
  put(dy + 3, (s.time * s.time / s.length / p.who.mass) * l.force);
  const auto turned = [&](const Ball& b, Vec3 torque) {
    return (s.time * s.time / (0.4 * b.mass * b.radius * b.radius)) * torque;
  };
  put(dy + 6, turned(p.given->sphere, l.torque));
  put(dy + 9, p.wall() ? Vec3{} : turned(*p.given->partner, l.partner_torque));
  const History<double>& h = l.reaction.history;
  constexpr double rate_scale = 1e6;
  put(dy + 12, rate_scale * ((1.0 / s.force) * h.slip - vector_at(y + 12)));
  put(dy + 15, rate_scale * ((1.0 / s.force) * h.roll - vector_at(y + 15)));
  dy[18] = rate_scale * (h.twist / (s.force * p.who.radius) - y[18]);
  return 0;
}

/// Touch, release of a held contact, the attraction's end, and the turn of the normal velocity.
enum Root { touch, release, leave, turn, roots };
/// Rising or falling: a pair that comes near passes the others the other way round, which tells nothing.
constexpr std::array<int, roots> root_directions{1, -1, -1, -1};
int root_functions(double, N_Vector state, double* root, void* data) {
  const Impact& p = *static_cast<const Impact*>(data);
  const Geometry g = geometry(p, N_VGetArrayPointer(state));
  root[touch] = g.overlap / p.scale.length;
  root[release] = (g.overlap + p.holds) / p.scale.length;
  root[leave] = (g.overlap + p.range) / p.scale.length;
  root[turn] = g.normal_velocity * p.scale.time / p.scale.length;
  return 0;
}

/// CVODE with what it allocates.
class Solver {
 public:
  explicit Solver(Impact& impact) {
    check(SUNContext_Create(nullptr, &context_), "SUNContext_Create");
    y_ = N_VNew_Serial(unknowns, context_);
    N_VConst(0.0, y_);
    matrix_ = SUNDenseMatrix(unknowns, unknowns, context_);
    linear_ = SUNLinSol_Dense(y_, matrix_, context_);
    cvode_ = CVodeCreate(CV_BDF, context_);
    check(CVodeInit(cvode_, right_hand_side, 0.0, y_), "CVodeInit");
    check(CVodeSStolerances(cvode_, tolerance, 0.01 * tolerance), "CVodeSStolerances");
    check(CVodeSetUserData(cvode_, &impact), "CVodeSetUserData");
    check(CVodeSetLinearSolver(cvode_, linear_, matrix_), "CVodeSetLinearSolver");
    check(CVodeRootInit(cvode_, roots, root_functions), "CVodeRootInit");
    std::array<int, roots> directions = root_directions;
    check(CVodeSetRootDirection(cvode_, directions.data()), "CVodeSetRootDirection");
    check(CVodeSetMaxNumSteps(cvode_, 200000), "CVodeSetMaxNumSteps");
    check(CVodeSetMaxStep(cvode_, 0.05), "CVodeSetMaxStep");
  }
  ~Solver() {
    CVodeFree(&cvode_);
    SUNLinSolFree(linear_);
    SUNMatDestroy(matrix_);
    N_VDestroy(y_);
    SUNContext_Free(&context_);
  }
  Solver(const Solver&) = delete;
  Solver& operator=(const Solver&) = delete;

  double* y() { return N_VGetArrayPointer(y_); }
  double time() const { return time_; }
  /// Makes one internal step, or a shorter one up to roots. Returns 1 or -1 for roots met rising or falling.
  std::array<int, roots> advance() {
    std::array<int, roots> crossed{};
    const int flag = CVode(cvode_, patience, y_, &time_, CV_ONE_STEP);
    check(flag, "CVode");
    if (flag == CV_ROOT_RETURN) check(CVodeGetRootInfo(cvode_, crossed.data()), "CVodeGetRootInfo");
    return crossed;
  }
  void restart() { check(CVodeReInit(cvode_, time_, y_), "CVodeReInit"); }

 private:
  static void check(int flag, const char* call) {
    if (flag < 0) throw std::runtime_error(fmt::format("collision: {} of SUNDIALS failed with flag {}", call, flag));
  }
  SUNContext context_ = nullptr;
  N_Vector y_ = nullptr;
  SUNMatrix matrix_ = nullptr;
  SUNLinearSolver linear_ = nullptr;
  void* cvode_ = nullptr;
  double time_ = 0.0;
};

/// The overlap at which the static force has taken the kinetic energy, the largest force on the way, and their time.
Scale scale_of(const Impact& p, double energy) {
  History<double> held;
  held.radius = 1.0;
  const auto push = [&](double overlap) {
    return p.laws->react(p.who, {{0.0, 0.0, 1.0}, overlap, {}, {}}, held, 0.0).push;
  };
  double overlap = 0.0, work = 0.0, force = 0.0;
  for (double step = 1e-12 * p.who.radius; work < energy && overlap < p.who.radius; step *= 1.05) {
    overlap += step;
    const double f = push(overlap - 0.5 * step);
    work += step * f;
    force = std::max(force, std::abs(f));
  }
  if (!(force > 0.0)) throw std::runtime_error("collision: the law has no repulsion");
  return {overlap, std::sqrt(p.who.mass * overlap / force), force};
}

Impact make_impact(const ForcePass& laws, const Encounter& e) {
  const Ball& a = e.sphere;
  Impact p;
  p.laws = &laws;
  p.given = &e;
  p.who.material = a.material;
  if (e.partner) {
    const Ball& b = *e.partner;
    p.who.partner = Partner::sphere;
    p.who.other = b.material;
    p.who.mass = a.mass * b.mass / (a.mass + b.mass);
    p.who.radius = a.radius * b.radius / (a.radius + b.radius);
    p.reach = a.radius + b.radius;
  } else {
    p.who.partner = Partner::body;
    p.who.other = e.body;
    p.who.mass = a.mass;
    p.who.radius = a.radius;
    p.reach = a.radius;
  }
  p.range = laws.range(std::max(a.radius, e.partner ? e.partner->radius : 0.0));
  p.holds = laws.holds(p.who);
  p.start = {0.0, 0.0, p.reach + p.range};
  const Vec3 v = a.velocity - (e.partner ? e.partner->velocity : Vec3{});
  p.scale = scale_of(p, 0.5 * p.who.mass * v.z * v.z);
  return p;
}

}  // namespace

Collision collide(const ForcePass& laws, const Encounter& e) {
  Impact p = make_impact(laws, e);
  if (p.range <= 0.0) p.phase = Phase::touching;
  Solver solver(p);
  const Vec3 before = e.sphere.velocity - (e.partner ? e.partner->velocity : Vec3{});
  const auto begin = [&](double* y) {
    put(y + 3, (p.scale.time / p.scale.length) * before);
    put(y + 6, p.scale.time * e.sphere.spin);
    if (e.partner) put(y + 9, p.scale.time * e.partner->spin);
  };
  begin(solver.y());
  solver.restart();

  Collision c;
  double touched_at = 0.0, released_at = 0.0;
  bool touched = p.phase == Phase::touching, over = before.z >= 0.0;
  while (!over) {
    const std::array<int, roots> crossed = solver.advance();
    const Geometry g = geometry(p, solver.y());
    if (p.phase == Phase::touching) {
      c.largest_overlap = std::max(c.largest_overlap, g.overlap);
      c.largest_push = std::max(c.largest_push, load_of(p, solver.y(), g).reaction.push);
    }
    if (p.phase == Phase::apart && crossed[touch] > 0) {
      touched = true;
      touched_at = solver.time();
      p.phase = Phase::touching;
      solver.restart();
    } else if (p.phase == Phase::touching && crossed[release] < 0) {
      released_at = solver.time();
      over = p.range <= p.holds;
      p.phase = Phase::apart;
      solver.restart();
    } else if (p.phase == Phase::apart && crossed[leave] < 0) {
      over = true;
    } else if (std::any_of(crossed.begin(), crossed.end(), [](int way) { return way != 0; })) {
      // CVODE gives up where a root function is zero at a root and right behind it, as a difference of distances may
      // be. Starting anew it waits until the function has left zero.
      solver.restart();
    }
    if (!over && ((touched && crossed[turn] < 0) || solver.time() >= patience)) {
      c.end = CollisionEnd::sticks;
      over = true;
    }
  }
  const double speed = p.scale.length / p.scale.time;
  const Vec3 after = speed * vector_at(solver.y() + 3);
  const double share = e.partner ? e.partner->mass / (e.sphere.mass + e.partner->mass) : 1.0;
  c.velocity = e.sphere.velocity + share * (after - before);
  c.spin = (1.0 / p.scale.time) * vector_at(solver.y() + 6);
  if (e.partner) {
    c.partner_velocity = e.partner->velocity - (1.0 - share) * (after - before);
    c.partner_spin = (1.0 / p.scale.time) * vector_at(solver.y() + 9);
  }
  if (c.end == CollisionEnd::sticks || !touched || before.z >= 0.0) return c;
  c.end = CollisionEnd::parted;
  c.restitution = dot(after, geometry(p, solver.y()).normal) / -before.z;
  c.duration = p.scale.time * (released_at - touched_at);
  return c;
}

}  // namespace dem
