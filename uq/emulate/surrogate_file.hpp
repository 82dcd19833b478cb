#pragma once
// Fitted surrogates with their validation in surrogate.h5 (surrogate/storage.hpp), so that they are fitted once. The
// file's study hash is of all that decides a surrogate (ranges and scales of parameters and controls, outputs, fit
// options, the program's version), its table hash of the rows of both levels.
#include <string>

#include "uq/emulate/surrogates.hpp"

namespace uq {

/// Hash of the rows' contents, in their order.
std::string table_hash(const data::RunTable& table);

void save_surrogates(const std::string& path, const data::Study& study, const data::RunTable& table,
                     const SurrogateOptions& options, const std::vector<FittedSurrogate>& fitted);

struct SavedSurrogates {
  std::vector<FittedSurrogate> fitted;  ///< for SurrogateOptions::known
  std::string stale;                    ///< why an existing file was not used; empty: it was used, or there is none
};

/// Loads the saved surrogates. It never throws for a damaged file: that is a reason to fit again.
SavedSurrogates load_surrogates(const std::string& path, const data::Study& study, const data::RunTable& table,
                                const SurrogateOptions& options);

}  // namespace uq
