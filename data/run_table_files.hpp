#pragma once
// The two files of a run table; read_table chooses by the ending.
#include <string>

#include "data/run_table.hpp"

namespace data {

TableRead read_table_hdf5(const std::string& path, const Study& study);
TableRead read_table_csv(const std::string& path, const Study& study);

}  // namespace data
