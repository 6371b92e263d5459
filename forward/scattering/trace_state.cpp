#include "forward/scattering/trace_state.h"

#include <cstring>
#include <type_traits>

#include "forward/base/digest.h"
#include "forward/base/error.h"
#include "forward/base/file_input.h"
#include "forward/base/file_output.h"

namespace mezzotint {

namespace {

constexpr std::string_view magic = "Mezzotint trace state 2\n";

// All parts of a state, in one order for the reader and the writer.
template <class State, class Use>
void for_each_part(State& state, const Use& use) {
  const auto number = [&](auto& value) { use(&value, sizeof(value)); };
  const auto map = [&](auto& values) { use(values.data(), values.size() * sizeof(values[0])); };
  number(state.rays_per_batch);
  number(state.passes);
  for (auto& tally : state.tallies) {
    map(tally.reflected);
    map(tally.transmitted);
    for (auto& order : tally.orders) map(order);
    map(tally.total_energy);
    number(tally.interactions);
    map(tally.arrivals);
    map(tally.arrived_weight);
    for (auto& part : tally.squares) map(part);
    for (auto& part : tally.negative) map(part);
    map(tally.largest_weight);
    number(tally.normal_fallbacks);
    number(tally.leaked);
  }
}

std::string head(const std::string& run) { return std::string(magic) + run + "\n"; }

}  // namespace

void read_state(const std::filesystem::path& path, const std::string& run, TraceState& state) {
  if (!std::filesystem::exists(path)) return;
  const std::vector<std::byte> bytes = read_file(path);
  const std::string expected = head(run);
  if (bytes.size() < expected.size() || std::memcmp(bytes.data(), magic.data(), magic.size()) != 0) {
    throw FileError(path, "byte 0", "is no state of a trace; give another file, or delete this one to start anew");
  }
  if (std::memcmp(bytes.data(), expected.data(), expected.size()) != 0) {
    throw FileError(path, "byte 24",
                    "is the state of another run (another relief, incidence, material, grid, seed or "
                    "method); give another file, or delete this one to start anew");
  }
  std::size_t size = expected.size() + 64;
  for_each_part(state, [&](const void*, std::size_t part) { size += part; });
  std::uint32_t marks = 0;
  const auto damaged = [&] { return FileError(path, "end", "is cut short or damaged; delete it to start anew"); };
  if (bytes.size() < size + sizeof(marks)) throw damaged();
  const auto* body = bytes.data() + expected.size();
  const std::string digest(reinterpret_cast<const char*>(body), 64);
  if (sha256_hex({body + 64, bytes.size() - expected.size() - 64}) != digest) throw damaged();
  const std::byte* at = body + 64;
  const auto take = [&](void* into, std::size_t part) {
    std::memcpy(into, at, part);
    at += part;
  };
  for_each_part(state, take);
  take(&marks, sizeof(marks));
  if (static_cast<std::size_t>(bytes.data() + bytes.size() - at) != marks * sizeof(TraceState::Mark)) throw damaged();
  state.convergence.resize(marks);
  take(state.convergence.data(), marks * sizeof(TraceState::Mark));
}

void write_state(const std::filesystem::path& path, const std::string& run, const TraceState& state) {
  std::string body;
  const auto put = [&](const void* from, std::size_t part) { body.append(static_cast<const char*>(from), part); };
  for_each_part(state, put);
  const auto marks = static_cast<std::uint32_t>(state.convergence.size());
  put(&marks, sizeof(marks));
  put(state.convergence.data(), marks * sizeof(TraceState::Mark));
  const std::string digest = sha256_hex({reinterpret_cast<const std::byte*>(body.data()), body.size()});
  write_file(path, head(run) + digest + body);
}

}  // namespace mezzotint
