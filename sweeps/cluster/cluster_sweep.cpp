// SPDX-License-Identifier: MIT
#include "sweeps/cluster/cluster_sweep.h"

#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <climits>
#include <cmath>
#include <csignal>
#include <cstring>
#include <exception>
#include <map>
#include <new>
#include <optional>
#include <set>
#include <utility>

#include "base/files/checksum.h"
#include "base/files/files.h"
#include "base/files/output_lock.h"
#include "base/system/clock.h"
#include "base/system/output.h"
#include "base/text/printable.h"
#include "base/text/readable.h"
#include "base/text/text.h"
#include "core/candidates.h"
#include "core/meshes/vessel.h"
#include "host/device.h"
#include "host/open_backend.h"
#include "sweeps/cluster/packet.h"
#include "sweeps/cluster/work_range.h"
#include "sweeps/lists/hand_lists.h"
#include "sweeps/result/output_names.h"
#include "sweeps/result/shard.h"
#include "sweeps/result/tally.h"
#include "sweeps/run/auto_backend.h"
#include "sweeps/run/ending.h"
#include "sweeps/run/sweep.h"
#include "sweeps/run/sweep_state.h"

namespace wholehand::sweeps {
namespace {

constexpr double REPORT_SHARE = 1.0 / 64;  // of the time so far: what a crash may cost, and each report takes a line in the mark

constexpr const char* SHARD_LOCK_END = ".lock";
constexpr const char* SHARED_FILES = "the result must lie on a file system that all ranks share, or ask for --shards";

std::string base_name(const std::string& path) { return path.substr(path.find_last_of('/') + 1); }

double since(double start) { return monotonic_now() - start; }

// Grips of a vessel that were computed in one go.
struct Piece {
  std::uint64_t vessel = 0, first = 0, last = 0;
  std::uint64_t group = 0;  // whose file holds them
  GripCounts counts;
  std::array<char, 64> checksum{};  // of what the file holds of them; empty: of nothing

  void set_checksum(const std::string& text) {
    std::memcpy(checksum.data(), text.data(), std::min(text.size(), checksum.size() - 1));
  }
};

// A file's grips, and what vouches for them. A rank keeps those that it is responsible for.
struct OwnStretch {
  std::uint64_t vessel = 0, first = 0, last = 0;
  std::uint64_t group = 0;
  std::array<char, 40> checksum{};

  OwnStretch() = default;
  OwnStretch(std::uint64_t of_vessel, std::uint64_t from, std::uint64_t to, std::uint64_t in_group, const char* text)
      : vessel(of_vessel), first(from), last(to), group(in_group) {
    std::memcpy(checksum.data(), text, std::min(std::strlen(text), checksum.size() - 1));
  }
  Stretch stretch() const { return {first, last, checksum.data()}; }
};

struct Cell {
  std::uint64_t number = 0;
  double score = 0;
};

// What a rank has done so far, for the lines at the end.
struct RankFigures {
  std::uint64_t grips = 0;
  double seconds = 0;
};

void put(PacketWriter& packet, const ListProgress& list) {
  packet.put(list.chosen);
  packet.put(list.decided.has_value());
  packet.put(list.decided.value_or(Candidate()));
  packet.put(list.is_complete);
}

ListProgress take_list(PacketReader& packet) {
  ListProgress list;
  list.chosen = packet.take_all<Candidate>();
  const bool is_decided = packet.take<bool>();
  const auto decided = packet.take<Candidate>();
  if (is_decided) list.decided = decided;
  list.is_complete = packet.take<bool>();
  return list;
}

std::optional<Error> caught(const std::function<void()>& work) {
  try {
    work();
  } catch (const Error& error) {
    return error;
  } catch (const std::bad_alloc&) {
    return failure_error("out of memory; ask for less at once");
  } catch (const std::exception& error) {
    return failure_error(std::string("unexpected failure: ") + error.what());
  }
  return std::nullopt;
}

template <class T>
T share_value(Team& team, const T& from_leader) {
  PacketWriter packet;
  packet.put(from_leader);
  return PacketReader(team.share(packet.bytes())).take<T>();
}

// The values of all ranks on the leader; elsewhere only the own one.
template <class T>
std::vector<T> gather_values(Team& team, const T& own) {
  PacketWriter packet;
  packet.put(own);
  std::vector<T> values{own};
  team.gather(packet.bytes(), [&](int, const std::string& message) { values.push_back(PacketReader(message).take<T>()); });
  return values;
}

std::vector<std::string> gather_texts(Team& team, const std::string& own) {
  std::vector<std::string> texts{own};
  team.gather(own, [&](int, const std::string& message) { texts.push_back(message); });
  return texts;
}

void put_error(PacketWriter& packet, const Team& team, const std::optional<Error>& error) {
  packet.put(error ? error->code : ExitCode::done);
  packet.put(error ? error->remedy : Remedy::none);
  packet.put(std::string(error ? error->what() : ""));
  packet.put(team.node());
}

std::optional<Error> take_error(PacketReader& packet, int rank) {
  const auto code = packet.take<ExitCode>();
  const auto remedy = packet.take<Remedy>();
  const std::string line = packet.take_text(), node = packet.take_text();
  if (code == ExitCode::done) return std::nullopt;
  return Error(code, fmt::format("rank {} on {}: {}", rank, node, line), remedy);
}

// Throws on every rank what the leader reports, if anything.
void share_error(Team& team, const std::optional<Error>& known) {
  const ExitCode code = share_value(team, known ? known->code : ExitCode::done);
  if (code == ExitCode::done) return;
  team.mark_agreed();
  if (team.is_leader()) throw *known;
  throw Error(code, "");
}

// All ranks throw an Error of any rank: the leader's own, or else the lowest rank's.
void agree(Team& team, const std::optional<Error>& own) {
  PacketWriter packet;
  put_error(packet, team, own);
  std::optional<Error> first = own;
  team.gather(packet.bytes(), [&](int rank, const std::string& message) {
    PacketReader reader(message);
    const auto error = take_error(reader, rank);
    if (!first) first = error;
  });
  share_error(team, first);
}

// A failure on one rank that no other knows about ends all ranks, because they would wait for it forever.
ExitCode or_abort(Team& team, const std::function<ExitCode()>& work) {
  try {
    return work();
  } catch (const std::exception& error) {
    if (team.is_agreed()) throw;
    print_note(fmt::format("rank {} on {}: {}", team.rank(), team.node(), error.what()));
    team.abort(ExitCode::failure);
  }
}

// Distributes several devices of the best kind on a node among its ranks. ON_AUTO is "vulkan" here: all ranks alike, whatever devices the nodes have.
std::string own_device(const Team& team, const std::string& asked) {
  if (asked == "core") return asked;
  const std::string on = asked == ON_AUTO ? "vulkan" : asked;
  const std::vector<host::DeviceInfo> devices = host::list_devices();
  const host::DeviceInfo& chosen = host::choose_device(devices, on);
  if (on != "vulkan") return on;
  std::vector<std::size_t> alike;
  for (const host::DeviceInfo& device : devices)
    if (device.kind == chosen.kind && device.unusable.empty()) alike.push_back(device.index);
  return fmt::format("vulkan:{}", alike[static_cast<std::size_t>(team.local_rank()) % alike.size()]);
}

class ClusterSweep {
 public:
  ClusterSweep(Team& team, const Scene& scene, const SweepOptions& options, const BackendChoice& choice, const SweepParts& parts,
               InterruptGuard& interrupt)
      : team_(team),
        interrupt_(interrupt),
        scene_(scene),
        options_(options),
        sweep_(scene, options, choice, parts, team.size() > 1 ? fmt::format("rank {} on {}: ", team.rank(), team.node()) : ""),
        figures_(static_cast<std::size_t>(team.size())) {}

  ExitCode run() {
    std::signal(SIGXFSZ, SIG_IGN);
    if (is_already_done()) return ExitCode::done;
    agree([&] { sweep_.open(); });
    compare_ranks();
    check_lost_mark();
    if (!all_of(!interrupt_.signalled())) {
      if (team_.is_leader())
        print_note("interrupted before the first grip; no file has changed, and the same command starts again");
      return ExitCode::interrupted;
    }
    if (team_.is_leader()) sweep_.print_header();
    contents_.emplace(sweep_.contents());
    open_files();
    set_lists();
    if (!repair() || !sweep() || (sweep_.needs_distinct_grips() && !choose()) || !read_back()) return interrupted();
    if (!team_.is_leader()) file_.reset();
    team_.meet();
    bool is_completed = false;
    const auto ending = [&] { is_completed = complete_together(); };
    if (team_.is_leader()) {
      state_.run_and_save_on_failure(*file_, ending);
    } else {
      ending();
    }
    if (!is_completed) return interrupted();
    remove_unused_shard();
    return ExitCode::done;
  }

 private:
  const Plan& plan() const { return sweep_.plan(); }
  ExitCode interrupted() const { return team_.is_leader() ? state_.interrupted() : ExitCode::interrupted; }

  // Takes the lock of the result, unless it is complete and the user has asked to resume.
  bool is_already_done() {
    bool is_done = false;
    agree([&] {
      check_shard_name();
      if (!team_.is_leader()) return;
      is_done = sweep_.is_already_complete();
      if (is_done) return;
      sweep_.check();
      lock_.emplace(sweep_.names().lock);
      is_done = sweep_.is_already_complete();  // by who had the lock until now
    });
    if (!share_flag(is_done)) return false;
    agree([&] {
      if (team_.is_leader()) sweep_.report_already_complete();
    });
    return true;
  }

  // The leader makes or resumes the result's file. All others open it, or the shard of their group.
  void open_files() {
    const OpenOutput& open_output = sweep_.parts().open_output;
    bool is_resumed = false;
    agree([&] {
      if (!team_.is_leader()) return;
      is_resumed = state_.begin();
      const FileStart start = is_resumed ? FileStart::resumed : options_.shards ? FileStart::sparse : FileStart::reserved;
      file_ = std::make_unique<ResultFile>(sweep_.names(), *contents_, sweep_.fields(), start, open_output);
      begin_shards();
      // from now on, shards of this sweep come with its mark
      if (options_.shards && !is_resumed) state_.save(*file_);
    });
    is_resumed = share_flag(is_resumed);
    share_groups();
    const FilePlaces places = share_places();
    bool is_there = true;
    agree([&] { is_there = open_shard(is_resumed); });
    share_stretches(is_there);
    agree([&] {
      const std::string& path = own_names_.partial;
      if (own_group() == 0 && access(path.c_str(), F_OK) != 0 && errno == ENOENT)
        throw failure_error(path + " is not there, though rank 0 has it; " + SHARED_FILES);
      if (!team_.is_leader()) file_ = std::make_unique<ResultFile>(own_names_, *contents_, sweep_.fields(), places, open_output);
    });
    compare_files();
  }

  // The first rank of a group opens its shard. False: it made a new one.
  bool open_shard(bool is_resumed) {
    own_names_ = sweep_.names();
    if (own_group() == 0) return true;
    own_names_.partial = shard_path(own_names_, groups_[own_group()].name);
    if (groups_[own_group()].ranks[0] != team_.rank()) return true;
    shard_lock_.emplace(own_names_.partial + SHARD_LOCK_END);
    if (is_resumed && is_shard(own_names_.partial, shard_id_)) return true;
    if (begins_with(own_names_.partial, SHARD_START))
      note_as_rank({own_names_.partial + " is a shard of another sweep: replacing it"});
    make_shard(own_names_.partial, shard_id_, layout_);
    return false;
  }

  // ---- what all do together ----

  // Does the work on each rank. All ranks throw an Error of any of them.
  void agree(const std::function<void()>& work) { sweeps::agree(team_, caught(work)); }
  void share_error(const std::optional<Error>& known) { sweeps::share_error(team_, known); }

  bool share_flag(bool from_leader) { return share_value(team_, from_leader); }

  // All ranks must compute the same, with the same program. They may use different devices; then the file names all.
  void compare_ranks() {
    std::map<std::string, std::string> own = sweep_.identity();
    PacketWriter packet;
    for (const auto& [key, value] : own) packet.put(checksum_text(value.data(), value.size()));
    for (const std::string& text :
         {sweep_.info().device, sweep_.info().driver, team_.node(), own.at("code"), base_name(sweep_.names().result)})
      packet.put(text);
    std::map<std::string, int> devices{{sweep_.info().device, 1}};
    std::set<std::string> drivers{sweep_.info().driver};
    devices_.push_back(sweep_.info().device);
    std::optional<Error> unlike;
    team_.gather(packet.bytes(), [&](int rank, const std::string& message) {
      PacketReader reader(message);
      std::vector<std::string> checksums;
      for (std::size_t k = 0; k < own.size(); ++k) checksums.push_back(reader.take_text());
      const std::string its_device = reader.take_text(), driver = reader.take_text(), node = reader.take_text(),
                        code = reader.take_text(), result = reader.take_text();
      std::size_t k = 0;
      for (const auto& [key, value] : own) {
        const std::string own_checksum = checksum_text(value.data(), value.size()), its = checksums[k++];
        if (its == own_checksum || key == "device" || key == "driver" || unlike) continue;
        const bool is_code = key == "code";
        unlike = usage_error(fmt::format("rank {} on {} has another {}: {}, and rank 0 on {} has {}; start the same on every node",
                                         rank, node, key, is_code ? code : its, team_.node(), is_code ? value : own_checksum));
      }
      if (!unlike && result != base_name(sweep_.names().result))
        unlike = usage_error(fmt::format("rank {} on {} writes {}, and rank 0 on {} writes {}; name the same result on every node",
                                         rank, node, result, team_.node(), base_name(sweep_.names().result)));
      ++devices[its_device];
      drivers.insert(driver);
      devices_.push_back(its_device);
    });
    share_error(unlike);
    if (team_.size() == 1) return;
    PacketWriter names;
    std::string all_devices, all_drivers, kinds;
    for (const auto& [name, count] : devices) kinds += (kinds.empty() ? "" : "; ") + name;
    for (const auto& [name, count] : devices) all_devices += fmt::format("{}{} x {}", all_devices.empty() ? "" : "; ", count, name);
    for (const std::string& driver : drivers) all_drivers += (all_drivers.empty() ? "" : "; ") + driver;
    names.put(all_devices);
    names.put(all_drivers);
    names.put(kinds);
    PacketReader reader(team_.share(names.bytes()));
    const std::string shared_devices = reader.take_text(), shared_drivers = reader.take_text(), shared_kinds = reader.take_text();
    sweep_.name_devices(shared_devices, shared_kinds, shared_drivers);
    if (team_.is_leader() && devices.size() > 1 && sweep_.info().backend != "core")
      print_note("the ranks have different devices: the last bits of a value depend on who computed it");
  }

  // ---- files: one for all ranks, or one for each node ----

  // Ranks that write into one file.
  struct Group {
    std::string name;        // of their shard
    std::vector<int> ranks;  // ascending
    bool is_new = false;     // their file has nothing of the resumed sweep
  };
  static constexpr std::uint64_t NOWHERE = ~std::uint64_t{0};  // the shard is not here
  static constexpr char LOST = '/';  // how the mark names a lost shard: its node may come back with a new one of the same name

  std::size_t own_group() const { return group_of_[static_cast<std::size_t>(team_.rank())]; }

  std::string own_name() const { return !options_.shards ? "" : options_.shards->empty() ? team_.node() : *options_.shards; }

  // Before any work: the file system would refuse a too long name only once the ranks are running.
  void check_shard_name() const {
    if (!options_.shards) return;
    const std::string file = base_name(shard_path(sweep_.names(), own_name()) + SHARD_LOCK_END);
    if (file.size() > NAME_MAX)
      throw usage_error(fmt::format(
          "{}: a file's name has {} letters at most; name another result with -o, or another shard with --shard", file, NAME_MAX));
  }

  // A sweep to resume whose mark is on another node must not start again, because that would replace all shards.
  void check_lost_mark() {
    struct stat file {};
    const bool is_new = options_.shards && options_.resume && stat(sweep_.names().mark.c_str(), &file) != 0;
    if (!share_flag(is_new)) return;
    agree([&] {
      const std::string path = shard_path(sweep_.names(), own_name());
      if (!begins_with(path, SHARD_START) && (team_.is_leader() || stat(sweep_.names().mark.c_str(), &file) != 0)) return;
      throw usage_error(
          fmt::format("{} is here, but on the node of rank 0 there is no {}; start rank 0 where that file is, or "
                      "begin the sweep anew without --resume",
                      begins_with(path, SHARD_START) ? path : sweep_.names().mark, sweep_.names().mark));
    });
  }

  void begin_shards() {
    if (!options_.shards) return;
    if (!mark_.shards) mark_.shards = ShardMark{new_shard_id(), file_->layout(), false};
    mark_.shards->is_ended = false;
  }

  // The leader's group comes first. It writes into the result's file, and all others into shards.
  void share_groups() {
    PacketWriter all;
    for (const std::string& name : gather_texts(team_, own_name())) all.put(name);
    all.put(mark_.shards ? mark_.shards->id : "");
    PacketReader reader(team_.share(all.bytes()));
    for (int rank = 0; rank < team_.size(); ++rank) {
      const std::string name = reader.take_text();
      const auto group = std::find_if(groups_.begin(), groups_.end(), [&](const Group& other) { return other.name == name; });
      group_of_.push_back(static_cast<std::size_t>(group - groups_.begin()));
      if (group == groups_.end()) groups_.push_back({name, {}});
      groups_[group_of_.back()].ranks.push_back(rank);
    }
    shard_id_ = reader.take_text();
  }

  // A node without grips leaves no file.
  void remove_unused_shard() {
    std::vector<std::uint64_t> used(groups_.size());
    for (const VesselProgress& vessel : mark_.vessels) {
      for (const Stretch& stretch : vessel.stretches)
        if (const std::uint64_t group = group_of(stretch); group != NOWHERE) used[group] = 1;
    }
    PacketWriter packet;
    packet.put(used);
    used = PacketReader(team_.share(packet.bytes())).take_all<std::uint64_t>();
    if (own_group() > 0 && used[own_group()] == 0 && groups_[own_group()].ranks[0] == team_.rank())
      unlink(own_names_.partial.c_str());
  }

  // Throws if ranks of one group have opened different files of one name.
  void compare_files() {
    const std::vector<std::uint64_t> inodes = gather_values(team_, file_->inode());
    const std::vector<std::string> nodes = gather_texts(team_, team_.node());
    std::optional<Error> unlike;
    for (std::size_t rank = 0; rank < inodes.size() && !unlike; ++rank) {
      const Group& group = groups_[group_of_[rank]];
      const auto first = static_cast<std::size_t>(group.ranks[0]);
      if (inodes[rank] == inodes[first]) continue;
      const std::string path = group_of_[rank] == 0 ? sweep_.names().partial : shard_path(sweep_.names(), group.name);
      const char* remedy = options_.shards
                               ? "who writes one shard must share a file system: give nodes other names with --shard NAME"
                               : SHARED_FILES;
      unlike = failure_error(
          fmt::format("rank {} on {}: {} is another file here than on rank {}; {}", rank, nodes[rank], path, first, remedy));
    }
    share_error(unlike);
  }

  // Assigns each stretch to a rank in turn: one that has it in its file or, if no file has it, any.
  class Turns {
   public:
    explicit Turns(const std::vector<Group>& groups, int ranks)
        : groups_(groups), ranks_(static_cast<std::size_t>(ranks)), turns_(groups.size() + 1) {}
    int next(std::uint64_t group) {
      if (group == NOWHERE) return static_cast<int>(turns_.back()++ % ranks_);
      const std::vector<int>& members = groups_[group].ranks;
      return members[turns_[group]++ % members.size()];
    }

   private:
    const std::vector<Group>& groups_;
    std::size_t ranks_;
    std::vector<std::size_t> turns_;
  };

  // Where the grips of a stretch lie, according to the leader's mark and the groups.
  std::uint64_t group_of(const Stretch& stretch) const {
    if (stretch.shard.empty()) return 0;
    for (std::size_t group = 1; group < groups_.size(); ++group)
      if (groups_[group].name == stretch.shard) return groups_[group].is_new ? NOWHERE : group;
    return NOWHERE;
  }

  std::string shard_of(std::uint64_t group) const { return group == 0 ? "" : groups_[group].name; }

  void note_missing_shards() const {
    std::uint64_t grips = 0;
    std::set<std::string> names;
    for (const VesselProgress& vessel : mark_.vessels) {
      for (const Stretch& stretch : vessel.stretches) {
        if (group_of(stretch) != NOWHERE) continue;
        grips += stretch.last - stretch.first;
        names.insert(stretch.shard.substr(stretch.shard[0] == LOST ? 1 : 0));
      }
    }
    if (grips == 0) return;
    print_note(fmt::format("no rank has the shard{} {}: computing {} again", names.size() > 1 ? "s" : "", joined(names, ", "),
                           counted(grips, "grip")));
  }

  // The stretches of the leader's mark that no shard has, by the rank that recomputes them, in its order. Marks them as lost.
  std::vector<std::vector<Stretch*>> lost_stretches() {
    std::vector<std::vector<Stretch*>> lost(static_cast<std::size_t>(team_.size()));
    Turns turns(groups_, team_.size());
    for (VesselProgress& vessel : mark_.vessels)
      for (Stretch& stretch : vessel.stretches)
        if (group_of(stretch) == NOWHERE) lost[static_cast<std::size_t>(turns.next(NOWHERE))].push_back(&stretch);
    for (const auto& of_rank : lost)
      for (Stretch* stretch : of_rank)
        if (stretch->shard[0] != LOST) stretch->shard.insert(0, 1, LOST);
    return lost;
  }

  // Which grips exist, where, and what vouches for them: each rank keeps its own part. `is_there`: this rank's file is not new.
  void share_stretches(bool is_there) {
    const std::vector<char> are_there = gather_values<char>(team_, is_there);
    for (std::size_t rank = 1; rank < are_there.size(); ++rank)
      if (!are_there[rank]) groups_[group_of_[rank]].is_new = true;
    PacketWriter packet;
    if (team_.is_leader()) {
      for (const VesselProgress& vessel : mark_.vessels) packet.put(vessel.done);
      std::vector<OwnStretch> stretches;
      for (std::size_t v = 0; v < mark_.vessels.size(); ++v)
        for (const Stretch& stretch : mark_.vessels[v].stretches)
          stretches.emplace_back(v, stretch.first, stretch.last, group_of(stretch), stretch.checksum.c_str());
      packet.put(stretches);
    }
    PacketReader reader(team_.share(packet.bytes()));
    mark_.vessels.resize(scene_.vessels.size());
    for (VesselProgress& vessel : mark_.vessels) vessel.done = reader.take<std::uint64_t>();
    stretches_ = {};
    Turns turns(groups_, team_.size());
    const auto stretches = reader.take_all<OwnStretch>();
    has_stretches_ = !stretches.empty();
    for (const OwnStretch& stretch : stretches)
      if (turns.next(stretch.group) == team_.rank()) stretches_.push_back(stretch);
  }

  FilePlaces share_places() {
    PacketWriter packet;
    if (file_) {
      packet.put(file_->places().variables);
      packet.put(file_->places().axes);
      packet.put(file_->places().height.has_value());
      packet.put(file_->places().height.value_or(0));
      packet.put(file_->places().best);
      packet.put(file_->layout().blocks);
    }
    PacketReader reader(team_.share(packet.bytes()));
    FilePlaces places;
    places.variables = reader.take_all<std::uint64_t>();
    places.axes = reader.take_all<std::uint64_t>();
    const bool has_height = reader.take<bool>();
    const auto height = reader.take<std::uint64_t>();
    if (has_height) places.height = height;
    places.best = reader.take_all<std::uint64_t>();
    layout_ = {plan().grips(), plan().copies(), reader.take_all<LayoutBlock>(), places.height, places.axes};
    return places;
  }

  void set_lists() {
    const std::size_t vessels = scene_.vessels.size();
    eligible_.resize(vessels);
    pending_.resize(vessels);
    while (maps_.size() < vessels) maps_.emplace_back(plan());
    for (const HeatMap& map : maps_) reported_cells_.push_back(map.scores());
    for (const VesselProgress& vessel : mark_.vessels) {
      best_.emplace_back(plan(), sweep_.kept_best(), vessel.best);
      fresh_.emplace_back(std::in_place, plan(), sweep_.kept_best(), std::vector<Candidate>());
    }
    has_eligible_ = sweep_.needs_distinct_grips() && state_.done() == 0;
    reported_ = state_.done();
  }

  // Each rank reads some of the stretches back, or recomputes them. From time to time the mark records where the latter now lie. False: interrupted.
  bool repair() {
    const bool is_whole = !has_stretches_ || repair_stretches();
    stretches_ = {};
    for (Group& group : groups_) group.is_new = false;
    return is_whole;
  }

  bool repair_stretches() {
    std::vector<std::vector<Stretch*>> lost;
    if (team_.is_leader()) {
      note_missing_shards();
      lost = lost_stretches();
    }
    const bool has_lost =
        share_flag(std::any_of(lost.begin(), lost.end(), [](const auto& stretches) { return !stretches.empty(); }));
    agree([&] {
      if (team_.is_leader() && has_lost) keep_mark();
    });
    bool is_whole = true;
    for (std::size_t next = 0; is_whole && !all_of(next == stretches_.size());) {
      last_report_ = monotonic_now();
      std::uint64_t restored = 0;
      std::optional<Error> failure = caught([&] {
        for (; is_whole && next < stretches_.size() && !(has_lost && is_report_due()); next += is_whole ? 1 : 0) {
          const OwnStretch& own = stretches_[next];
          is_whole = own.group == NOWHERE ? sweep_.restore_stretch(own.vessel, own.stretch(), *file_, interrupt_)
                                          : sweep_.repair_stretch(own.vessel, own.stretch(), *file_, interrupt_);
          if (is_whole && own.group == NOWHERE) ++restored;
        }
      });
      if (const auto unsynced = caught([&] { file_->sync(); })) {
        restored = 0;
        if (!failure) failure = unsynced;
      }
      const bool is_moved = move_stretches(lost, restored);
      agree([&] {
        if (team_.is_leader() && is_moved) keep_mark();
        if (failure) throw *failure;
      });
      is_whole = all_of(is_whole);
    }
    return is_whole;
  }

  // Each rank has restored `restored` more of its lost stretches in its file. Tells the leader whether there are any.
  bool move_stretches(std::vector<std::vector<Stretch*>>& lost, std::uint64_t restored) {
    const std::vector<std::uint64_t> counts = gather_values(team_, restored);
    bool is_moved = false;
    for (std::size_t rank = 0; rank < lost.size(); ++rank) {
      const auto end = lost[rank].begin() + static_cast<std::ptrdiff_t>(counts.at(rank));
      for (auto stretch = lost[rank].begin(); stretch != end; ++stretch) (*stretch)->shard = shard_of(group_of_[rank]);
      is_moved = is_moved || counts[rank] > 0;
      lost[rank].erase(lost[rank].begin(), end);
    }
    return is_moved;
  }

  // Each rank reads back what it wrote: a single rank would take longer than all ranks take for the grips. False: interrupted.
  bool read_back() {
    bool is_whole = true;
    agree([&] {
      file_->drop_cached();
      for (const OwnStretch& own : written_)
        is_whole = is_whole && sweep_.repair_stretch(own.vessel, own.stretch(), *file_, interrupt_);
      if (is_whole) file_->sync();
    });
    is_whole = all_of(is_whole);
    agree([&] {
      if (team_.is_leader() && !is_whole) keep_mark();
    });
    if (is_whole && groups_.size() == 1) share_checksums();
    return is_whole;
  }

  // Each rank computes the checksums of some blocks of the result, for the same reason, but not of the best grips, which do not exist yet.
  void share_checksums() {
    PacketWriter packet;
    agree([&] {
      if (!team_.is_leader()) return;
      checksums_ = checksum_parts(sweep_.names().partial);
      packet.put(checksums_.parts.size());
      for (const ChecksumPart& part : checksums_.parts) {
        packet.put(part.variable);
        packet.put(part.range);
      }
    });
    PacketReader reader(team_.share(packet.bytes()));
    std::vector<ChecksumPart> parts(reader.take<std::size_t>());
    std::vector<std::pair<ChecksumPart*, std::uint64_t>> blocks;
    for (ChecksumPart& part : parts) {
      part.variable = reader.take_text();
      part.range = reader.take<FileRange>();
      for (std::uint64_t block = 0; block < part.block_count() && !part.variable.starts_with("best_"); ++block)
        blocks.emplace_back(&part, block);
    }
    const auto ranks = static_cast<std::size_t>(team_.size());
    std::string own;
    agree([&] {
      for (auto k = static_cast<std::size_t>(team_.rank()); k < blocks.size(); k += ranks)
        own += file_->block_checksum(*blocks[k].first, blocks[k].second);
    });
    const std::vector<std::string> found = gather_texts(team_, own);
    if (!team_.is_leader()) return;
    for (std::size_t k = 0; k < blocks.size(); ++k)
      blocks[k].first->blocks.push_back(found[k % ranks].substr(k / ranks * CHECKSUM_LENGTH, CHECKSUM_LENGTH));
    for (std::size_t k = 0; k < parts.size(); ++k) checksums_.parts[k].blocks = std::move(parts[k].blocks);
  }

  bool all_of(bool own) {
    const std::vector<char> all = gather_values<char>(team_, own);
    return share_flag(std::find(all.begin(), all.end(), 0) == all.end());
  }

  // ---- the counter's work ----

  // Takes pieces until there are none, or until one was not finished; then nobody gets another. `compute` returns how many grips of a range it has
  // done.
  void take_pieces(const WorkRange& work, const std::function<std::uint64_t(const GripRange&)>& compute) {
    PieceSize size(team_.size(), work.size(), options_.tuning.piece_seconds);
    const double began = monotonic_now();
    std::uint64_t asked = size.next(work.size(), 0);
    team_.ask(asked);
    try {
      for (std::uint64_t first = team_.answer(); first < work.size(); first = team_.answer()) {
        const std::vector<GripRange> piece = work.piece(first, asked);
        asked = size.next(work.size() - std::min(work.size(), first + asked), since(began));
        team_.ask(asked);  // the next one: the answer comes while this one is computed
        const double start = monotonic_now();
        std::uint64_t grips = 0;
        for (const GripRange& range : piece) {
          const std::uint64_t done = compute(range);
          grips += done;
          if (done < range.last - range.first) return team_.stop_counter();
        }
        if (sweep_.is_asked_to_end(interrupt_)) return team_.stop_counter();
        size.done(grips, since(start));
      }
    } catch (...) {
      team_.stop_counter();
      throw;
    }
  }

  bool is_report_due() const {
    return since(last_report_) >= std::max(options_.tuning.mark_seconds, REPORT_SHARE * since(options_.started));
  }

  // False: interrupted; the mark has what is done.
  bool sweep() {
    std::vector<GripRange> left;
    for (std::size_t v = 0; v < scene_.vessels.size(); ++v)
      if (mark_.vessels[v].done < plan().grips()) left.push_back({v, mark_.vessels[v].done, plan().grips()});
    const WorkRange work(std::move(left));
    team_.restart_counter();
    last_report_ = monotonic_now();
    if (team_.is_leader()) progress_.emplace(sweep_.total(), reported_, "grips", progress_sink(ProgressSink::none));
    const std::optional<Error> failure = caught([&] {
      take_pieces(work, [&](const GripRange& range) { return compute(range); });
      file_->sync();  // of all: passes may read what any rank wrote
    });
    if (!team_.is_leader()) {
      // what is not on the disk is not reported
      if (failure && caught([&] { file_->sync(); })) pieces_.clear();
      report_to_leader(true, failure);
    } else {
      if (failure) failure_ = failure;
      while (ended_ + 1 < team_.size()) {
        if (!listen()) Team::nap();
        if (is_report_due() && !failure_) failure_ = caught([&] { keep_mark(); });
      }
      progress_->clear();
      if (state_.done() < sweep_.total() || failure_ || state_.is_saved()) {
        const std::optional<Error> unsaved = caught([&] { keep_mark(); });
        if (!failure_) failure_ = unsaved;
      }
      set_best();
    }
    share_error(failure_);
    has_eligible_ = share_flag(has_eligible_);
    return share_flag(state_.done() == sweep_.total());
  }

  // Computes a range, with reports in time. Returns how many of its grips are done.
  std::uint64_t compute(const GripRange& range) {
    std::uint64_t first = range.first;
    while (first < range.last) {
      first = compute_until_due({range.vessel, first, range.last});
      if (is_report_due()) {
        if (team_.is_leader()) {
          keep_mark();
        } else {
          file_->sync();
          report_to_leader(false, std::nullopt);
        }
        last_report_ = monotonic_now();
      }
      if (is_to_end()) break;
    }
    return first - range.first;
  }

  bool is_to_end() { return sweep_.is_asked_to_end(interrupt_) || team_.is_stopped(); }  // the latter: another rank ends

  // Computes a range until its end, a report or the end of the sweep is due. Returns the first grip that is not done.
  std::uint64_t compute_until_due(const GripRange& range) {
    Piece piece{range.vessel, range.first, range.first, 0, {}, {}};
    std::uint64_t delivered = 0;
    std::vector<Candidate> eligible;
    RunRequest request = sweep_.grips_of(range.vessel, range.first, range.last, interrupt_);
    request.best = sweep_.ranks_here() ? 0 : sweep_.candidates();
    request.sink = [&](const PlaneChunk& chunk) {
      file_->write(chunk);
      count_grips(chunk, sweep_.fields(), sweep_.gate(range.vessel), piece.counts);
      if (sweep_.ranks_here()) {
        eligible.clear();
        add_eligible(chunk, sweep_.fields(), eligible);
        offer(range.vessel, eligible);
        cache_scores(range.vessel, eligible);
      }
      if (sweep_.has_heat_map()) maps_[range.vessel].add(plan(), chunk, sweep_.fields());
      delivered += chunk.count;
      if (team_.is_leader()) show(delivered);
      if (is_report_due() || sweep_.is_time_up() || team_.is_stopped()) interrupt_.flag() = true;
    };
    const double start = monotonic_now();
    const RunResult result = state_.run(std::move(request));
    interrupt_.clear();
    sweep_.check_delivered(result, delivered, is_to_end());
    if (delivered == 0) piece.counts.grips += result.done;
    offer(range.vessel, result.best);
    own_.seconds += since(start);
    own_.grips += result.done;
    note_as_rank(result.notes);
    piece.last += result.done;
    if (file_->has_grips() && result.done > 0) {
      piece.set_checksum(file_->stretch().checksum);
      file_->end_stretch();
      written_.emplace_back(piece.vessel, piece.first, piece.last, 0, piece.checksum.data());
    }
    if (result.done > 0) keep(piece);
    return piece.last;
  }

  void offer(std::size_t vessel, const std::vector<Candidate>& grips) {
    for (const Candidate& grip : grips) {
      if (!best_[vessel].takes(grip)) continue;
      best_[vessel].offer({grip});
      if (!team_.is_leader()) fresh_[vessel]->offer({grip});
    }
  }

  // Up to a bound: then passes compute their grips again.
  void cache_scores(std::size_t vessel, const std::vector<Candidate>& eligible) {
    if (!has_eligible_) return;
    eligible_count_ += eligible.size();
    has_eligible_ = eligible_count_ * sizeof(Candidate) <= options_.tuning.cached_scores * sizeof(double);
    if (has_eligible_) {
      eligible_[vessel].insert(eligible_[vessel].end(), eligible.begin(), eligible.end());
    } else {
      for (auto& grips : eligible_) grips = {};
    }
  }

  void note_as_rank(std::vector<std::string> notes) {
    for (std::string& line : notes) line = sweep_.rank_prefix() + line;
    state_.note_once(notes, progress_ ? &*progress_ : nullptr);
  }

  // ---- reports to the leader ----

  void keep(const Piece& piece) {
    if (!team_.is_leader()) {
      pieces_.push_back(piece);
      return;
    }
    pending_[piece.vessel][piece.first] = piece;
    reported_ += piece.last - piece.first;
    advance(piece.vessel);
    figures_[0] = own_;
  }

  // Pieces that follow the finished grips without a gap join them. Pieces after a gap wait, because a mark only knows grips without gaps.
  void advance(std::size_t vessel) {
    VesselProgress& progress = mark_.vessels[vessel];
    auto& pending = pending_[vessel];
    while (!pending.empty() && pending.begin()->first == progress.done) {
      const Piece& piece = pending.begin()->second;
      progress.done = piece.last;
      progress.counts += piece.counts;
      if (piece.checksum[0] != '\0')
        progress.stretches.push_back({piece.first, piece.last, piece.checksum.data(), shard_of(piece.group)});
      pending.erase(pending.begin());
    }
  }

  // Everything since the last report; what it names is on the disk.
  void report_to_leader(bool is_last, const std::optional<Error>& failure) {
    PacketWriter packet;
    packet.put(is_last);
    put_error(packet, team_, failure);
    packet.put(has_eligible_);
    packet.put(own_);
    packet.put(std::exchange(mark_.kernel_seconds, 0));
    packet.put(std::exchange(pieces_, {}));
    for (std::size_t v = 0; v < scene_.vessels.size(); ++v) {
      packet.put(fresh_[v]->all());
      fresh_[v].emplace(plan(), sweep_.kept_best(), std::vector<Candidate>());
      std::vector<Cell> cells;
      for (std::size_t k = 0; sweep_.has_heat_map() && k < reported_cells_[v].size(); ++k) {
        const double now = maps_[v].scores()[k];
        if (std::isnan(now) || now == reported_cells_[v][k]) continue;
        cells.push_back({k, now});
        reported_cells_[v][k] = now;
      }
      packet.put(cells);
    }
    team_.send(packet.bytes());
  }

  // Takes a report, if one is there.
  bool listen() {
    std::string message;
    int from = 0;
    if (!team_.receive(message, from)) return false;
    PacketReader packet(message);
    ended_ += packet.take<bool>() ? 1 : 0;
    const auto failure = take_error(packet, from);
    if (!failure_) failure_ = failure;
    has_eligible_ = packet.take<bool>() && has_eligible_;
    figures_[static_cast<std::size_t>(from)] = packet.take<RankFigures>();
    mark_.kernel_seconds += packet.take<double>();
    for (Piece& piece : packet.take_all<Piece>()) {
      piece.group = group_of_[static_cast<std::size_t>(from)];
      pending_[piece.vessel][piece.first] = piece;
      reported_ += piece.last - piece.first;
    }
    for (std::size_t v = 0; v < scene_.vessels.size(); ++v) {
      best_[v].offer(packet.take_all<Candidate>());
      for (const Cell& cell : packet.take_all<Cell>()) maps_[v].raise(cell.number, cell.score);
      advance(v);
    }
    return true;
  }

  void show(std::uint64_t under_way) {
    while (listen()) {
    }
    if (progress_->is_due()) progress_->update(rate_text(), reported_ + under_way);
  }

  // "3 x core, 1 thread 12.3 thousand grips/s".
  std::string rate_text() const {
    std::map<std::string, std::array<double, 2>> rates;  // ranks, and grips a second of all
    for (std::size_t rank = 0; rank < figures_.size(); ++rank) {
      auto& [count, rate] = rates[devices_[rank]];
      count += 1;
      if (figures_[rank].seconds > 0) rate += static_cast<double>(figures_[rank].grips) / figures_[rank].seconds;
    }
    std::string text;
    for (const auto& [device, sum] : rates)
      text += fmt::format("{}{:.0f} x {} {} grips/s", text.empty() ? "" : "; ", sum[0], device, readable_number(sum[1]));
    return text;
  }

  void print_ranks() const {
    if (team_.size() > 1) print(fmt::format("{} ranks: {}\n", team_.size(), rate_text()));
  }

  void print_shards() const {
    if (!state_.has_shards()) return;
    std::set<std::string> files;
    for (const VesselProgress& vessel : mark_.vessels)
      for (const Stretch& stretch : vessel.stretches)
        if (!stretch.shard.empty()) files.insert(shard_path(sweep_.names(), stretch.shard));
    print(one_line(fmt::format("the other grips lie in {}; once all are in one folder, `wholehand merge {}` makes one file",
                               joined(files, ", "), sweep_.names().result)) +
          "\n");
  }

  // The best of what the mark knows to be done.
  void set_best() {
    for (std::size_t v = 0; v < best_.size(); ++v) {
      VesselProgress& progress = mark_.vessels[v];
      if (!progress.lists.empty()) continue;  // they are chosen
      progress.best.clear();
      for (const Candidate& grip : best_[v].all())
        if (grip.index < progress.done) progress.best.push_back(grip);
    }
  }

  void keep_mark() {
    set_best();
    state_.save(*file_);
    last_report_ = monotonic_now();
  }

  // ---- lists of grips that differ ----

  bool choose() {
    if (options_.shards) share_stretches(true);
    for (std::size_t v = 0; v < scene_.vessels.size(); ++v) {
      VesselProgress& vessel = mark_.vessels[v];
      const bool is_first = share_flag(vessel.lists.empty());
      ListChooser chooser(plan(), sweep_.evaluator(), v, sweep_.list_request(), vessel.lists);
      if (team_.is_leader() && is_first) chooser.offer(vessel.best);
      if (is_first) end_pass_together(v, chooser);
      while (!share_flag(chooser.is_complete())) {
        const bool is_passed = pass(v, chooser);
        if (is_passed) end_pass_together(v, chooser);
        agree([&] {
          if (team_.is_leader() && (!is_passed || is_report_due())) keep_mark();
        });
        if (!is_passed) return false;
      }
    }
    stretches_ = {};
    return true;
  }

  // The leader decides, and all ranks find the hands that it requests.
  void end_pass_together(std::size_t v, ListChooser& chooser) {
    const auto ranks = static_cast<std::size_t>(team_.size()), rank = static_cast<std::size_t>(team_.rank());
    const auto own_part = [&](const std::vector<Candidate>& grips, std::size_t of) {
      std::vector<Candidate> part;
      for (std::size_t i = of; i < grips.size(); i += ranks) part.push_back(grips[i]);
      return part;
    };
    if (!team_.is_leader()) {
      for (;;) {
        const auto grips = PacketReader(team_.share("")).take_all<Candidate>();
        if (grips.empty()) return;
        std::vector<FoundHand> found;
        for (const auto& hand : chooser.hands_of(own_part(grips, rank)))
          found.push_back({hand.has_value(), hand.value_or(PosedHand())});
        PacketWriter packet;
        packet.put(found);
        team_.send(packet.bytes());
      }
    }
    const auto ask = [&](const std::vector<Candidate>& grips) {
      PacketWriter packet;
      packet.put(grips);
      team_.share(packet.bytes());
    };
    state_.end_pass(v, chooser, [&](const std::vector<Candidate>& grips) {
      ask(grips);
      ListChooser::Hands hands(grips.size());
      const ListChooser::Hands own = chooser.hands_of(own_part(grips, 0));
      for (std::size_t k = 0; k < own.size(); ++k) hands[k * ranks] = own[k];
      for (std::size_t other = 1; other < ranks; ++other) {
        const auto found = PacketReader(team_.wait_for(static_cast<int>(other))).take_all<FoundHand>();
        for (std::size_t k = 0; k < found.size(); ++k)
          if (found[k].is_there) hands.at(k * ranks + other) = found[k].hand;
      }
      return hands;
    });
    ask({});
  }

  // All grips of a vessel once more, by all ranks: from memory, else from the file, else recomputed. The file matters to a sweep of several sessions,
  // each shorter than the grips take. False: interrupted.
  bool pass(std::size_t v, ListChooser& leaders) {
    std::vector<ListProgress> lists(plan().hand_scales());
    PacketWriter packet;
    if (team_.is_leader())
      for (const ListProgress& list : leaders.progress()) put(packet, list);
    PacketReader reader(team_.share(packet.bytes()));
    for (ListProgress& list : lists) list = take_list(reader);
    ListChooser own(plan(), sweep_.evaluator(), v, sweep_.list_request(), lists);
    std::uint64_t delivered = 0;
    if (!has_eligible_) team_.restart_counter();
    agree([&] {
      if (has_eligible_) {
        own.offer(eligible_[v]);
      } else if (options_.shards && file_->has_eligible()) {
        for (const OwnStretch& stretch : stretches_)
          if (stretch.vessel == v) delivered += read_range({v, stretch.first, stretch.last}, own);
      } else {
        take_pieces(WorkRange({{v, 0, plan().grips()}}), [&](const GripRange& range) {
          const std::uint64_t done = file_->has_eligible() ? read_range(range, own) : pass_range(range, own);
          delivered += done;
          return done;
        });
      }
    });
    PacketWriter found;
    found.put(delivered);
    found.put(own.open_grips());
    if (team_.is_leader()) leaders.add_open(own.open_grips());
    team_.gather(found.bytes(), [&](int, const std::string& message) {
      PacketReader grips(message);
      delivered += grips.take<std::uint64_t>();
      leaders.add_open(grips.take_all<Candidate>());
    });
    return share_flag((has_eligible_ && !sweep_.is_asked_to_end(interrupt_)) || delivered == plan().grips());
  }

  std::uint64_t read_range(const GripRange& range, ListChooser& own) const {
    constexpr std::uint64_t AT_ONCE = 1 << 18;  // grips: memory does not grow with the sweep
    for (std::uint64_t first = range.first; first < range.last; first += AT_ONCE)
      own.offer(file_->eligible(range.vessel, first, std::min(range.last, first + AT_ONCE)));
    return range.last - range.first;
  }

  std::uint64_t pass_range(const GripRange& range, ListChooser& own) {
    RunRequest request = sweep_.grips_of(range.vessel, range.first, range.last, interrupt_);
    std::vector<Candidate> eligible;
    request.sink = [&](const PlaneChunk& chunk) {
      eligible.clear();
      add_eligible(chunk, sweep_.fields(), eligible);
      own.offer(eligible);
      if (sweep_.is_time_up() || team_.is_stopped()) interrupt_.flag() = true;
    };
    const RunResult result = state_.run(std::move(request));
    note_as_rank(result.notes);
    return result.done;
  }

  // ---- figures of the best ----

  int rank_of(std::size_t list) const { return static_cast<int>(list % static_cast<std::size_t>(team_.size())); }

  // False: interrupted.
  bool complete_together() {
    BestLists best(scene_.vessels.size() * plan().hand_scales());
    agree([&] {
      if (team_.is_leader()) best = find_best(sweep_, state_);
    });
    const bool is_completed = choose_best_together(best);
    agree([&] {
      if (!team_.is_leader()) return;
      if (!is_completed) return state_.save(*file_);
      publish(sweep_, state_, *file_, std::move(best), std::move(checksums_));
      print_ranks();
      print_shards();
    });
    return is_completed;
  }

  // Each rank chooses, refines and scores the grips of some of the lists. False: interrupted.
  bool choose_best_together(BestLists& best) {
    PacketWriter packet;
    for (const auto& list : best) {
      std::vector<Candidate> grips;
      for (const BestGrip& grip : list) grips.push_back(grip.candidate);
      packet.put(grips);
    }
    PacketReader reader(team_.share(packet.bytes()));
    BestLists own(best.size());
    for (std::size_t list = 0; list < best.size(); ++list) {
      const auto grips = reader.take_all<Candidate>();
      if (rank_of(list) != team_.rank()) continue;
      for (const Candidate& candidate : grips) own[list].push_back(bare_grip(plan(), list / plan().hand_scales(), candidate));
    }
    bool is_whole = true;
    agree([&] { is_whole = choose_best(sweep_, own, interrupt_); });
    for (std::size_t list = 0; list < own.size(); ++list) {
      const int rank = rank_of(list);
      if (team_.is_leader()) {
        best[list] = rank == 0 ? std::move(own[list]) : PacketReader(team_.wait_for(rank)).take_all<BestGrip>();
      } else if (rank == team_.rank()) {
        PacketWriter completed;
        completed.put(own[list]);
        team_.send(completed.bytes());
      }
    }
    return all_of(is_whole);
  }

  struct FoundHand {
    bool is_there = false;
    PosedHand hand{};
  };

  Team& team_;
  InterruptGuard& interrupt_;
  const Scene& scene_;
  const SweepOptions& options_;
  Sweep sweep_;
  SweepState state_{sweep_};
  SweepMark& mark_ = state_.mark();  // the leader's is saved
  std::vector<HeatMap>& maps_ = state_.maps();
  std::optional<OutputLock> lock_, shard_lock_;
  std::optional<ResultContents> contents_;
  OutputNames own_names_;  // the partial file is a shard in the groups that write one
  std::unique_ptr<ResultFile> file_;
  ChecksumParts checksums_;                       // of the result, as far as ranks have found some
  std::vector<std::string> devices_;              // of all ranks; the leader knows them
  std::vector<OwnStretch> stretches_;             // that are there, and that this rank looks after
  bool has_stretches_ = false;                    // any rank
  std::vector<HandLists> best_;                   // of each vessel, so far
  std::vector<std::optional<HandLists>> fresh_;   // and since the last report
  std::vector<std::vector<Candidate>> eligible_;  // of each vessel, of this rank's grips
  std::size_t eligible_count_ = 0;
  bool has_eligible_ = false;                        // all of them
  std::vector<std::vector<double>> reported_cells_;  // cells of the heat maps that the leader knows
  std::vector<Piece> pieces_;                        // since the last report
  std::vector<OwnStretch> written_;                  // by this rank
  std::vector<Group> groups_;
  std::vector<std::size_t> group_of_;  // of each rank
  std::string shard_id_;               // of the sweep; empty where all write into one file
  RunLayout layout_;
  RankFigures own_;
  double last_report_ = 0;
  // of the leader
  std::vector<std::map<std::uint64_t, Piece>> pending_;  // of each vessel: done after a gap, by their first grip
  std::vector<RankFigures> figures_;
  std::uint64_t reported_ = 0;
  int ended_ = 0;
  std::optional<Error> failure_;
  std::optional<Progress> progress_;
};

ExitCode run_on(const BackendChoice& choice, Team& team, const Scene& scene, const SweepOptions& options, const SweepParts& parts,
                InterruptGuard& interrupt) {
  return or_abort(team, [&] {
    std::optional<ClusterSweep> sweep;
    agree(team, caught([&] { sweep.emplace(team, scene, options, choice, parts, interrupt); }));
    return sweep->run();
  });
}

}  // namespace

void leave_cluster_sweep(Team& team, const Error& error) {
  try {
    agree(team, error);
  } catch (const Error&) {
    // which the leader says
  }
}

ExitCode run_cluster_sweep(Team& team, const Scene& scene, const SweepOptions& options, const SweepParts& parts,
                           InterruptGuard& interrupt) {
  return run_on(named_backend(options.on, options.precision), team, scene, options, parts, interrupt);
}

ExitCode run_cluster_sweep(Team& team, const std::function<Scene()>& read_scene, const SweepOptions& options,
                           InterruptGuard& interrupt) {
  Scene scene;
  BackendChoice chosen;
  or_abort(team, [&] {
    agree(team, caught([&] {
            scene = read_scene();
            chosen = named_backend(own_device(team, options.on), options.precision);
          }));
    return ExitCode::done;
  });
  SweepOptions own = options;
  if (own.threads == 0) own.threads = team.own_processors();  // on a device, of what the core does besides
  SweepParts parts;
  parts.open_backend = [&](const BackendChoice& choice, const FieldSet& fields) {
    return open_backend(scene, fields, choice.on, choice.precision, own.threads);
  };
  parts.open_evaluator = [&] { return make_core_evaluator(scene); };
  parts.prepare = [&](const BackendChoice& choice) {
    load_meshes(scene, [&] { return largest_buffer(choice.on); });
    return choice;
  };
  parts.open_core = [&](const Scene& other, const FieldSet& fields) {
    return open_backend(other, fields, "core", Precision::full, own.threads);
  };
  parts.open_output = Team::open_output;
  return run_on(chosen, team, scene, own, parts, interrupt);
}

}  // namespace wholehand::sweeps
