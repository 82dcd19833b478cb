#pragma once
// A search for what a sampler does not know: maxima of a density p that its mixture q (uq/infer/student_mixture.hpp)
// gives no mass. A sampler that lost a mode while it tempered never sees it again, and its chains agree all the same.
// This search shares neither the sampler's chains nor its tempering.
//
// 1. Scouts: draws of the reference with their log densities. A region with share v of the reference escapes n of them
//    with probability (1 - v)^n.
//    (A sampler adds draws of its own where p is more than q expects: a spike inside a wide mode is found by those.)
// 2. Scouts higher than all around them are starts: the best of its leaf in each of several trees that halve the scouts
//    along random directions. Further starts are the maxima along lines through a known point: every axis, and every
//    diagonal of the scouts' box. Mirror images and repeated modes lie on such lines in any dimension.
// 3. From each start uphill, by a trust region with a BFGS model so that no step jumps into another basin. It ends
//    where p is as high as in the bulk of the draws and q knows the place, p(x) <= level q(x), or at a maximum.
// 4. The mass of an unknown maximum is first Laplace's (laplace.hpp). Where that would matter, draws of this normal law
//    tell how much mass lies inside the support where q does not know it: in a corner of a flat density Laplace's is
//    too large by 2 for each face.
#include <array>
#include <cstdint>
#include <vector>

#include "uq/infer/laplace.hpp"
#include "uq/infer/log_density.hpp"
#include "uq/infer/student_mixture.hpp"

namespace uq {

struct ExploreOptions {
  int scouts = 0;         ///< number of scouts; 0: by the dimension (scouts_for)
  int climbs = 48;        ///< starts followed at most
  int line_points = 160;  ///< points along each line
  int threads = 0;
};

/// The usual number of scouts: 1,000 in one dimension to 32,000 in five or more.
int scouts_for(int dimension);

struct Scouts {
  Eigen::MatrixXd x;  ///< rows
  Eigen::VectorXd log_density;
  Eigen::VectorXd low, high;  ///< range of the scouts in each coordinate
};
Scouts send_scouts(const Target& target, data::RandomStream& random, const ExploreOptions& options = {});

/// Number of draws within about two standard deviations of a maximum.
Eigen::Index draws_near(const Peak& mode, const Eigen::MatrixXd& draws);
/// Log of the mass of p near a peak, by importance sampling as in log_unknown_mass.
double log_mass_near(const Target& target, const Peak& peak, std::int64_t& evaluations);

/// The knowledge of a sampler: a place is known where p(x) <= exp(log_level) q(x) for every mixture. In the far tails
/// of q this holds of any place, so a climb goes on to where p is at least exp(log_bulk).
struct Knowledge {
  std::vector<Mixture> mixtures;
  std::vector<double> log_levels;
  double log_bulk = nowhere;  ///< density that most draws have
  bool knows(const Eigen::VectorXd& x, double log_density) const {
    for (std::size_t i = 0; i < mixtures.size(); ++i)
      if (!(log_density - mixtures[i].log_density(x) <= log_levels[i])) return false;
    return true;
  }
};

/// Log of the mass of p in places about a peak that the knowledge does not reach, by importance sampling from the
/// peak's normal law, wider by a third; minus infinity where no draw finds such a place.
double log_unknown_mass(const Target& target, const Peak& peak, const Knowledge& knowledge, std::int64_t& evaluations);

struct Search {
  std::vector<Peak> modes;  ///< unknown maxima, each once
  int starts = 0;           ///< starts that were followed
  std::int64_t evaluations = 0;
};

/// Places from which the search begins beside the scouts.
struct Origins {
  Eigen::VectorXd through;      ///< the point that the lines are laid through
  Eigen::MatrixXd starts = {};  ///< rows: further starts
};

Search search_unknown(const Target& target, const Scouts& scouts, const Knowledge& knowledge, const Origins& origins,
                      const ExploreOptions& options = {});

}  // namespace uq
