// SPDX-License-Identifier: MIT
// wholehand merge: makes one result of the files that machines without a common file system wrote.
#include <CLI/CLI.hpp>

#include <filesystem>
#include <memory>
#include <string>

#include "app/commands/commands.h"
#include "app/commands/validators.h"
#include "sweeps/run/merge.h"

namespace wholehand {

void add_merge_command(CLI::App& app, Action& action) {
  const auto request = std::make_shared<sweeps::MergeRequest>();
  CLI::App* command = app.add_subcommand("merge", "Make one result of the shards that the nodes of a cluster wrote");
  command->add_option("result", request->result, "Result of `wholehand-mpi sweep --shards`, by the name that the sweep was given")
      ->type_name("FILE.nc")
      ->required()
      ->check(not_empty());
  command->add_option("--from", request->folders, "Folder in which shards are looked for, too; may be given several times")
      ->type_name("DIR")
      ->allow_extra_args(false)
      ->check(CLI::Validator(
          [](const std::string& path) {
            return std::filesystem::is_directory(path) ? std::string() : "\"" + path + "\" is no folder; name one that is there";
          },
          ""));
  command->callback([request, &action] { action = [request] { return sweeps::merge_shards(*request); }; });
}

}  // namespace wholehand
