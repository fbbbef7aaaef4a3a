// How options are declared, and the options that both commands have.
#pragma once

#include <CLI/CLI.hpp>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <variant>

#include "tools/command_line.h"
#include "tools/option_values.h"

namespace gltf_radiosity::tools {

/// The part of an option that people read.
struct OptionText {
  std::string name;
  std::string type;         ///< what to write after the name
  std::string preset;       ///< the default as one would write it
  std::string description;  ///< with the unit
};

/// Adds an option whose value `read` takes; what it throws as BadValue becomes a message that names the option.
CLI::Option* add(CLI::App& app, const OptionText& text, const std::function<void(const std::string&)>& read);

/// Adds an option that may be given several times; `read` takes each value.
CLI::Option* add_repeated(CLI::App& app, const OptionText& text, const std::function<void(const std::string&)>& read);

/// Adds an option that chooses one of the named values.
template <typename Value, std::size_t count>
void add_choice(CLI::App& app, const std::string& name, const std::string& description, Value& value,
                const Choices<Value, count>& choices) {
  add(app, {name, names_of(choices), name_of(value, choices), description},
      [&value, &choices](const std::string& text) { value = parse_choice(text, choices); });
}

// Options refer to what they fill: it must outlive `app`.

void add_input_options(CLI::App& app, Options& options);
void add_light_options(CLI::App& app, Options& options);
void add_threads_option(CLI::App& app, Options& options);
void add_json_option(CLI::App& app, std::string& json);
void add_progress_option(CLI::App& app, ProgressStyle& progress);
void add_version_and_help(CLI::App& app);

/// Refuses a file `option` writes that is one of the `others`, which it would replace.
void check_that_differs(const std::string& option, const std::string& file, std::span<const std::string> others);

/// Parses and then calls `finish`. Answers how the program ends if that is all there is to do: --help, --version, or a
/// mistake.
std::optional<Ending> parse_with(CLI::App& app, std::span<const char* const> arguments,
                                 const std::function<void()>& finish);

/// Whether the first argument is the name of a subcommand.
bool names_subcommand(std::span<const char* const> arguments, std::string_view name);

/// What follows a subcommand's name. `Parser` holds an `app` that fills in a `command`; `finish` is called with that.
template <typename Parser, typename Finish>
auto parse_subcommand(std::span<const char* const> arguments, const Finish& finish)
    -> std::variant<decltype(Parser::command), Ending> {
  Parser parser;
  if (auto ending = parse_with(parser.app, arguments.subspan(1), [&] { finish(parser.command); })) {
    return std::move(*ending);
  }
  return std::move(parser.command);
}

}  // namespace gltf_radiosity::tools
