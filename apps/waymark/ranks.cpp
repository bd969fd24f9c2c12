#include "ranks.hpp"

#include <algorithm>
#include <array>
#include <cstdlib>

#ifdef WAYMARK_HAVE_MPI
#include <chrono>
#include <thread>
#include <utility>

#include <mpi.h>

#include "console.hpp"
#endif

namespace waymark::app {
namespace {

/// Starting MPI takes time, so only where somebody started several of us.
bool started_by_mpirun() {
  constexpr std::array kSigns{"OMPI_COMM_WORLD_SIZE", "PMI_SIZE", "PMIX_RANK"};
  return std::ranges::any_of(kSigns, [](const char* name) { return std::getenv(name) != nullptr; });
}

}  // namespace

#ifdef WAYMARK_HAVE_MPI

namespace {

constexpr int kResultTag = 1;  // to the first: a row as text, empty at the beginning
constexpr int kRunTag = 2;     // from the first: the place of a run among the points of the plan
constexpr int kNoMore = -1;

std::string receive_text(const MPI_Status& status) {
  int size = 0;
  MPI_Get_count(&status, MPI_CHAR, &size);
  std::string text(static_cast<std::size_t>(size), '\0');
  MPI_Recv(text.data(), size, MPI_CHAR, status.MPI_SOURCE, kResultTag, MPI_COMM_WORLD, MPI_STATUS_IGNORE);
  return text;
}

void keep_result(std::string text, study::Sweep& sweep) {
  if (text.empty()) return;
  auto rows = study::parse_rows(std::move(text), "result", sweep.plan());
  if (!rows) return;
  for (auto& row : *rows) sweep.finish(std::move(row));
}

}  // namespace

Result<std::unique_ptr<Ranks>> Ranks::join() {
  std::unique_ptr<Ranks> ranks(new Ranks);
  if (!started_by_mpirun()) return ranks;
  int provided = 0;
  MPI_Init_thread(nullptr, nullptr, MPI_THREAD_FUNNELED, &provided);
  MPI_Comm_rank(MPI_COMM_WORLD, &ranks->rank_);
  MPI_Comm_size(MPI_COMM_WORLD, &ranks->count_);
  return ranks;
}

Ranks::~Ranks() {
  int is_running = 0;
  MPI_Initialized(&is_running);
  if (is_running == 0) return;
  while (is_first() && answer(nullptr)) std::this_thread::sleep_for(std::chrono::milliseconds(10));
  if (!is_first() && dismissed_ == 0) ask("");  // the first waits for every other; it has stopped handing out
  MPI_Finalize();
}

int Ranks::ask(const std::string& result) {
  MPI_Send(result.data(), static_cast<int>(result.size()), MPI_CHAR, 0, kResultTag, MPI_COMM_WORLD);
  int run = kNoMore;
  MPI_Recv(&run, 1, MPI_INT, 0, kRunTag, MPI_COMM_WORLD, MPI_STATUS_IGNORE);
  if (run == kNoMore) dismissed_ = 1;
  return run;
}

bool Ranks::serve(study::Sweep& sweep) { return answer(&sweep); }

bool Ranks::answer(study::Sweep* sweep) {
  while (dismissed_ + 1 < count_) {
    int has_message = 0;
    MPI_Status status;
    MPI_Iprobe(MPI_ANY_SOURCE, kResultTag, MPI_COMM_WORLD, &has_message, &status);
    if (has_message == 0) return true;
    std::string result = receive_text(status);
    if (sweep != nullptr) keep_result(std::move(result), *sweep);
    const auto next = sweep != nullptr ? sweep->take() : std::nullopt;
    const int run = next ? static_cast<int>(*next) : kNoMore;
    dismissed_ += next ? 0 : 1;
    MPI_Send(&run, 1, MPI_INT, status.MPI_SOURCE, kRunTag, MPI_COMM_WORLD);
  }
  return false;
}

void Ranks::work(const study::SweepPlan& plan) {
  const auto points = study::points(plan);
  std::string result;
  for (int run = ask(result); run != kNoMore; run = ask(result)) {
    const auto row =
        study::make_run(plan, points[static_cast<std::size_t>(run)], [] { return !interrupted(); });
    result = row ? study::csv(plan, {*row}) : "";
  }
}

#else

Result<std::unique_ptr<Ranks>> Ranks::join() {
  if (started_by_mpirun())
    return Error{
        "this program was built without MPI and cannot be started by mpirun; install libopenmpi-dev and "
        "build again"};
  return std::unique_ptr<Ranks>(new Ranks);
}

Ranks::~Ranks() = default;

bool Ranks::serve(study::Sweep& /*sweep*/) { return false; }

void Ranks::work(const study::SweepPlan& /*plan*/) {}

#endif

}  // namespace waymark::app
