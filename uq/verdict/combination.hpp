#pragma once
// The combination of several parameters that a cloud of equally good values shares. Columns x_i of values; forms
//   product   prod x_i^e_i             log of each
//   sum       sum c_i x_i^p_i          p_i = 1; for pairs also 2 and 3
// In each form's terms t_i, divided by their sds, the direction v of least spread is the smallest eigenvector of their
// correlation matrix, and the spread along it, sqrt(eigenvalue), is 1 where the terms are independent. The combination
// holds when that spread is a small share of what each of its terms alone spreads in it, min |v_i|. Of the forms, the
// one of least spread is taken, the simple ones first where others hardly do better; exponents and coefficients become
// small whole numbers where these hold as well.
//
// A relation that is much tighter than any form, but not independent either, is curved. How tight is seen by nearest
// neighbours: in ranks of each column, the mean log distance of a point to its nearest, against that of the same values
// shuffled; exp of the difference, to the power of the dimension, is the share of the room that the cloud fills.
#include <Eigen/Dense>
#include <string>
#include <vector>

#include "uq/findings/kinds.hpp"

namespace uq {

struct CombinationTerm {
  double power = 1.0;        ///< e_i in a product, p_i in a sum
  double coefficient = 1.0;  ///< c_i in a sum; 1 in a product
};

struct FittedCombination {
  CombinationForm form = CombinationForm::none;
  std::vector<CombinationTerm> terms;  ///< one per column
  double spread = 1.0;                 ///< spread along the direction; 1 for independent terms
  double share = 1.0;                  ///< spread over that of the least term; it holds below combination_share
  bool exact_numbers = false;          ///< powers or coefficients are small whole numbers
};

/// The best of the forms for these columns; whether it holds is the caller's question. `ranges`: widths of the columns'
/// ranges, by which a value is told from zero.
FittedCombination fit_combination(const Eigen::MatrixXd& values, const Eigen::VectorXd& ranges);

/// Value of the combination at one row.
double evaluate(const FittedCombination& combination, const Eigen::VectorXd& row);

/// Share of the room that the cloud fills, 1 for independent columns.
double filled_share(const Eigen::MatrixXd& values);

/// How a column is written: its name, or name/(1e-18 J) where units would be mixed.
struct CombinationColumn {
  std::string name, unit;
  double typical = 1.0;  ///< typical size of the column's values
};
struct CombinationText {
  std::string text;           ///< "friction - 0.091 x hamaker/(1e-18 J)"
  std::string unit;           ///< unit of the text's value; empty: a pure number
  double scale = 1.0;         ///< value in the text = scale * evaluate(...)
  FittedCombination written;  ///< with coefficients as printed, values in the columns' own units
};
CombinationText write_combination(const FittedCombination& combination, const std::vector<CombinationColumn>& columns);

}  // namespace uq
