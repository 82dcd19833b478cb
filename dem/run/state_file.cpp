#include "dem/run/state_file.hpp"

#include <cstring>
#include <type_traits>

#include "data/error.hpp"
#include "dem/run/outputs.hpp"

namespace dem {
namespace {

/// Calls visit(name, vector) for each vector of the state; rows are plain data.
template <class AnyState, class Visit>
void each_vector(AnyState& s, Visit&& visit) {
  visit("position", s.position);
  visit("motion", s.motion);
  visit("half", s.half);
  visit("load", s.load);
  visit("reference", s.reference);
  visit("id", s.id);
  visit("ghost", s.ghost);
  visit("pair", s.pair);
  visit("partner_load", s.partner_load);
  visit("in_range", s.in_range);
  visit("history_at", s.history_at);
  visit("chunk_first", s.chunk_first);
  visit("chunk_pair", s.chunk_pair);
  visit("chunk_wall", s.chunk_wall);
  visit("halo_owner", s.halo_owner);
  visit("halo_part", s.halo_part);
  visit("wall", s.wall);
  visit("features", s.features);
  visit("feature_gap", s.feature_gap);
}

/// The chunks' pools, one after the other.
template <class Row>
struct Pooled {
  std::vector<Row> rows;
  std::vector<std::uint32_t> free, size;  ///< size: width, rows and places given back of each chunk
};
template <class Row>
Pooled<Row> pooled(const std::vector<Pool<Row>>& pools) {
  Pooled<Row> all;
  for (const Pool<Row>& pool : pools) {
    all.rows.insert(all.rows.end(), pool.rows.begin(), pool.rows.end());
    all.free.insert(all.free.end(), pool.free.begin(), pool.free.end());
    for (const std::size_t size : {std::size_t{pool.width}, pool.rows.size(), pool.free.size()})
      all.size.push_back(static_cast<std::uint32_t>(size));
  }
  return all;
}
template <class Row>
std::vector<Pool<Row>> unpooled(const Pooled<Row>& all) {
  std::vector<Pool<Row>> pools;
  auto row = all.rows.begin();
  auto free = all.free.begin();
  for (std::size_t k = 0; k + 2 < all.size.size(); k += 3) {
    const auto rows = static_cast<std::ptrdiff_t>(all.size[k + 1]),
               places = static_cast<std::ptrdiff_t>(all.size[k + 2]);
    if (rows > all.rows.end() - row || places > all.free.end() - free) break;
    pools.push_back({all.size[k], {row, row + rows}, {free, free + places}});
    row += rows;
    free += places;
  }
  return pools;
}
/// Calls visit(name, vector) for the parts of the two kinds of pool.
template <class AnyHistory, class AnyMemory, class Visit>
void each_pooled(AnyHistory& history, AnyMemory& memory, Visit&& visit) {
  visit("history", history.rows);
  visit("history_free", history.free);
  visit("history_size", history.size);
  visit("wall_memory", memory.rows);
  visit("wall_memory_free", memory.free);
  visit("wall_memory_size", memory.size);
}

}  // namespace

void write_checkpoint(const data::Hdf5Group& group, const Checkpoint& now) {
  group.set("step", static_cast<std::int64_t>(now.state.step));
  group.set("rebuilds", static_cast<std::int64_t>(now.state.rebuilds));
  group.set("dissipated_J", now.state.dissipated);
  group.set("rebuild_step", static_cast<std::int64_t>(now.state.rebuild_step));
  const auto write = [&](const char* name, const auto& rows) {
    const std::size_t row = sizeof(rows[0]);
    std::vector<std::uint8_t> bytes(rows.size() * row);
    for (std::size_t i = 0; i < rows.size(); ++i) {
      auto one = rows[i];
#if __has_builtin(__builtin_clear_padding)                                          // clang-tidy reads this file, too
      if constexpr (std::is_class_v<decltype(one)>) __builtin_clear_padding(&one);  // equal runs give equal files
#endif
      std::memcpy(bytes.data() + i * row, &one, row);
    }
    group.write(name, bytes, {rows.size(), row});
  };
  each_vector(now.state, write);
  const Pooled<VectorRow> history = pooled(now.state.history);
  const Pooled<WallMemory> memory = pooled(now.state.wall_memory);
  each_pooled(history, memory, write);
  const Progressing& p = now.under_way;
  group.write("under_way", std::vector<double>{static_cast<double>(p.steps), static_cast<double>(p.deep_contacts),
                                               p.max_overlap, p.cpu_seconds});
  group.write("sums_under_way", p.sums);
  group.set("pictures_under_way", std::int64_t{p.exposure.pictures});
  group.write("covered_under_way", p.exposure.covered);
}

Checkpoint read_checkpoint(const data::Hdf5Group& group) {
  Checkpoint now;
  now.state.step = static_cast<std::uint64_t>(group.integer("step"));
  now.state.rebuilds = static_cast<std::uint64_t>(group.integer("rebuilds"));
  now.state.dissipated = group.number("dissipated_J");
  now.state.rebuild_step = static_cast<std::uint64_t>(group.integer("rebuild_step"));
  const auto read = [&](const char* name, auto& rows) {
    const auto bytes = group.read<std::uint8_t>(name);
    const std::size_t row = sizeof(rows[0]);
    if (bytes.shape.size() != 2 || bytes.shape[1] != row) {
      throw data::InputError(data::ExitStatus::bad_data, {group.place(name), "is a checkpoint of another build",
                                                          "start the run again from the beginning"});
    }
    rows.resize(bytes.shape[0]);
    if (!rows.empty()) std::memcpy(static_cast<void*>(rows.data()), bytes.values.data(), bytes.values.size());
  };
  each_vector(now.state, read);
  Pooled<VectorRow> history;
  Pooled<WallMemory> memory;
  each_pooled(history, memory, read);
  now.state.history = unpooled(history);
  now.state.wall_memory = unpooled(memory);
  const std::vector<double> p = group.read<double>("under_way").values;
  if (p.size() != 4)
    throw data::InputError(data::ExitStatus::bad_data, {group.place("under_way"), "is a checkpoint of another build",
                                                        "start the run again from the beginning"});
  if (!group.has("covered_under_way")) return {};  // of before there were silhouettes
  now.under_way = {.steps = static_cast<std::uint64_t>(p[0]),
                   .sums = group.read<double>("sums_under_way").values,
                   .deep_contacts = static_cast<std::uint64_t>(p[1]),
                   .max_overlap = p[2],
                   .cpu_seconds = p[3],
                   .exposure = {.pictures = static_cast<int>(group.integer("pictures_under_way")),
                                .covered = group.read<std::uint8_t>("covered_under_way").values}};
  // The file is from before there was one of the outputs, or of a steady run that was kept without its last state.
  if (now.under_way.sums.size() != mean_outputs().size()) return {};
  return now;
}

}  // namespace dem
