#include "experiments/sweep/ranks.h"

#include <cstdlib>
#include <cstring>

#include "experiments/sweep/rank_link.h"

#ifdef MEZZOTINT_MPI
#define OMPI_SKIP_MPICXX 1
#include <mpi.h>
#endif

namespace mezzotint {

namespace {

const char* first_set(std::initializer_list<const char*> names) {
  for (const char* name : names)
    if (const char* value = std::getenv(name)) return value;
  return nullptr;
}

}  // namespace

#ifdef MEZZOTINT_MPI

Ranks::Ranks() : link_(std::make_unique<Link>()) {
  // Outside of a launcher MPI would cost a tenth of a second and open sockets.
  if (first_set({"OMPI_COMM_WORLD_SIZE", "PMI_SIZE", "PMIX_RANK"}) == nullptr) return;
  int provided = 0;
  if (MPI_Init_thread(nullptr, nullptr, MPI_THREAD_FUNNELED, &provided) != MPI_SUCCESS)
    throw MethodError("MPI did not start; start the program without mpirun or srun");
  MPI_Comm_rank(MPI_COMM_WORLD, &link_->rank);
  MPI_Comm_size(MPI_COMM_WORLD, &link_->count);
  link_->started = true;
}

Ranks::~Ranks() {
  if (link_->started) MPI_Finalize();
}

void Ranks::Link::send(int to, Note note, std::string_view bytes) const {
  MPI_Send(bytes.data(), static_cast<int>(bytes.size()), MPI_BYTE, to, static_cast<int>(note), MPI_COMM_WORLD);
}

std::optional<Letter> Ranks::Link::receive(int from) const {
  int there = 0, size = 0;
  MPI_Status status;
  MPI_Iprobe(from, MPI_ANY_TAG, MPI_COMM_WORLD, &there, &status);
  if (there == 0) return {};
  MPI_Get_count(&status, MPI_BYTE, &size);
  Letter letter{static_cast<Note>(status.MPI_TAG), std::string(static_cast<std::size_t>(size), '\0')};
  MPI_Recv(letter.bytes.data(), size, MPI_BYTE, from, status.MPI_TAG, MPI_COMM_WORLD, MPI_STATUS_IGNORE);
  return letter;
}

#else

Ranks::Ranks() : link_(std::make_unique<Link>()) {
  const char* size = first_set({"OMPI_COMM_WORLD_SIZE", "PMI_SIZE"});
  if (size != nullptr && std::atoi(size) > 1)
    throw MethodError(
        "this program was built without MPI, so that each of the processes would do all of the work; build it with "
        "-DMEZZOTINT_MPI=ON (Debian: libopenmpi-dev), or start it without mpirun");
}

Ranks::~Ranks() = default;
void Ranks::Link::send(int, Note, std::string_view) const {}
std::optional<Letter> Ranks::Link::receive(int) const { return {}; }

#endif

int Ranks::rank() const { return link_->rank; }
int Ranks::count() const { return link_->count; }

void Ranks::stop_others(const std::string& why, ExitStatus status) {
  const auto number = static_cast<std::uint64_t>(status);
  if (!is_first()) {
    link_->send(0, Note::Gone, numbered(number, why));
    return;
  }
  for (int other = 1; other < count(); ++other) link_->send(other, Note::Stop, numbered(number));
}

std::string numbered(std::uint64_t number, std::string_view rest) {
  std::string bytes(sizeof number, '\0');
  std::memcpy(bytes.data(), &number, sizeof number);
  return bytes.append(rest);
}

std::uint64_t number_of(std::string_view bytes) {
  std::uint64_t number = 0;
  require(bytes.size() >= sizeof number, "a letter between ranks is too short");
  std::memcpy(&number, bytes.data(), sizeof number);
  return number;
}

std::string_view rest_of(std::string_view bytes) { return bytes.substr(sizeof(std::uint64_t)); }

std::string bytes_of(const std::vector<double>& values) {
  std::string bytes(values.size() * sizeof(double), '\0');
  if (!values.empty()) std::memcpy(bytes.data(), values.data(), bytes.size());
  return bytes;
}

std::vector<double> doubles_of(const std::string& bytes) {
  require(bytes.size() % sizeof(double) == 0, "a list of numbers has a broken last one");
  std::vector<double> values(bytes.size() / sizeof(double));
  if (!values.empty()) std::memcpy(values.data(), bytes.data(), bytes.size());
  return values;
}

}  // namespace mezzotint
