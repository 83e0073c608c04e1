// SPDX-License-Identifier: Apache-2.0
#include "launch/tools/manual/man_page.h"

#include <fmt/core.h>

#include <algorithm>
#include <cctype>

#include "common/base/build_info.h"
#include "common/config/key_description.h"

namespace shoal::launch {
namespace {

// Escapes text, so that no character is special to the formatter.
std::string Roff(std::string_view text) {
  std::string out;
  for (char c : text) {
    // At the start of a line these characters would begin a request.
    if ((c == '.' || c == '\'') && (out.empty() || out.back() == '\n')) out += "\\&";
    switch (c) {
      case '\\':
        out += "\\e";
        break;
      case '-':
        out += "\\-";  // a minus: a search for "-" does not find a hyphen
        break;
      case '^':
        out += "\\(ha";
        break;
      case '~':
        out += "\\(ti";
        break;
      case '\'':
        out += "\\(aq";
        break;
      case '`':
        out += "\\(ga";
        break;
      default:
        out += c;
    }
  }
  return out;
}

std::string Title(const std::string& name, int section) {
  std::string upper = name;
  std::ranges::transform(upper, upper.begin(), [](unsigned char c) { return std::toupper(c); });
  // Left-adjusted and without hyphenation, so that names of options and presets stay whole.
  return fmt::format(".TH {} {} \"\" \"Shoal {}\" \"Shoal\"\n.nh\n.ad l\n", Roff(upper), section,
                     Roff(BuildVersion()));
}

// A meaning for the NAME section: in lower case, without a full stop.
std::string Brief(std::string meaning) {
  if (meaning.starts_with("Shoal ")) meaning.erase(0, 6);
  const size_t end = meaning.find(". ");
  if (end != std::string::npos) meaning.resize(end);
  if (meaning.ends_with('.')) meaning.pop_back();
  // An acronym keeps its capital letters.
  if (meaning.size() > 1 && std::islower(static_cast<unsigned char>(meaning[1]))) {
    meaning[0] = static_cast<char>(std::tolower(static_cast<unsigned char>(meaning[0])));
  }
  return meaning;
}

std::string OptionEntry(const OptionText& option) {
  std::string names;
  if (option.flags.empty()) {
    names = fmt::format("\\fI{}\\fR", Roff(option.name));
  }
  for (const std::string& flag : option.flags) {
    names += fmt::format("{}\\fB{}\\fR", names.empty() ? "" : ", ", Roff(flag));
  }
  if (!option.takes.empty()) names += fmt::format(" {}", Roff(option.takes));
  return fmt::format(".TP\n{}\n{}\n", names, Roff(option.meaning));
}

std::string Options(const CommandText& command) {
  std::string text;
  for (const OptionText& option : command.options) text += OptionEntry(option);
  return text;
}

std::string CommandSection(const CommandText& command) {
  return fmt::format(".SS {}\n{}\n.PP\n.B {}\n{}", Roff(command.name), Roff(command.meaning),
                     Roff(command.usage), Options(command));
}

constexpr char kExitStatus[] = R"(.SH EXIT STATUS
.TP
.B 0
success
.TP
.B 1
something failed at run time; one line on standard error says what
.TP
.B 2
the command line or the configuration is invalid
.TP
.B 3
a number was not finite: simulation, weights or losses
.PP
A program that stops cleanly after SIGINT, SIGTERM or SIGHUP ends by that signal, which a shell
shows as 130, 143 or 129.
)";

}  // namespace

std::string ProgramPage(const CommandText& program, const std::string& see_also) {
  std::string page = Title(program.name, 1);
  page += fmt::format(".SH NAME\n{} \\- {}\n.SH SYNOPSIS\n.B {}\n.SH DESCRIPTION\n{}\n",
                      Roff(program.name), Roff(Brief(program.meaning)), Roff(program.usage),
                      Roff(program.meaning));
  page += ".SH OPTIONS\n" + Options(program);
  if (!program.commands.empty()) page += ".SH COMMANDS\n";
  for (const CommandText* command : AllCommands(program)) {
    if (command != &program) page += CommandSection(*command);
  }
  page += kExitStatus;
  if (!see_also.empty()) page += ".SH SEE ALSO\n" + Roff(see_also) + "\n";
  return page;
}

std::string ConfigurationPage() {
  std::string page = Title("shoal-configuration", 5);
  page +=
      ".SH NAME\nshoal\\-configuration \\- keys that describe a training run\n.SH DESCRIPTION\n" +
      Roff(
          "A run is described by one set of keys, each with a default. A preset changes some "
          "(shoal train --preset NAME), a file changes more (--config FILE), and --set KEY=VALUE "
          "overrides both. In JSON files sections are nested objects: {\"learner\": {\"batch\": "
          "256}}; with --set they are dotted: learner.batch=256. The value after = is JSON; a bare "
          "word is a string.\nshoal config --schema prints the same as a JSON Schema.") +
      "\n.SH KEYS\n";
  for (const KeyDescription& key : DescribeEachKey()) {
    page += fmt::format(".TP\n\\fB{}\\fR = {}\n{}.\n.br\nTakes {}.\n", Roff(key.path),
                        Roff(key.default_value), Roff(key.meaning), Roff(key.takes));
  }
  page += ".SH SEE ALSO\n" + Roff("shoal(1)") + "\n";
  return page;
}

}  // namespace shoal::launch
