// SPDX-License-Identifier: Apache-2.0
#include "launch/watch/top_table.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <nlohmann/json.hpp>
#include <optional>

#include "launch/watch/metrics_view.h"
#include "launch/watch/run_figures.h"
#include "launch/watch/terminal_block.h"

namespace shoal::launch {
namespace {

using Process = MetricsMessage;

// A cell: its text, and the number to sort by.
struct Cell {
  std::string text = "-";
  std::optional<double> number{};
};

std::optional<double> Get(const Process& process, std::string_view name) {
  const auto figure = FigureOf(process, name);
  return figure && std::isfinite(*figure) ? figure : std::nullopt;
}

Cell Text(const std::string& text) { return {text.empty() ? "-" : text}; }

Cell Number(const std::optional<double>& value, const char* format = "{:.0f}") {
  if (!value) return {};
  return {fmt::format(fmt::runtime(format), *value), value};
}

Cell Share(const std::optional<double>& value, const std::string& after = "") {
  if (!value) return {};
  return {fmt::format("{:.0f} %{}", 100 * *value, after), value};
}

// NAME_p50, _p90 and _p99.
Cell Quantiles(const Process& process, const std::string& name, const char* format) {
  const auto p50 = Get(process, name + "_p50"), p90 = Get(process, name + "_p90"),
             p99 = Get(process, name + "_p99");
  if (!p50 || !p90 || !p99) return {};
  const std::string one = format;
  return {fmt::format(fmt::runtime(one + "/" + one + "/" + one), *p50, *p90, *p99), p50};
}

Cell Rate(const Process& process) {
  for (const auto& [name, unit] :
       {std::pair("env_steps_per_second", "steps"), std::pair("updates_per_second", "updates"),
        std::pair("stored_records_per_second", "records")}) {
    if (process.role == "coordinator") break;  // its rates are the sums of all
    const auto rate = Get(process, name);
    if (rate) return {fmt::format("{:.1f} {}/s", *rate, unit), rate};
  }
  return {};
}

// Pending work: chunks (replay), batches (learner), records not yet stored (actor).
Cell Queue(const Process& process) {
  for (const char* name : {"queue_depth", "batches_ready", "outstanding"}) {
    if (const auto depth = Get(process, name)) return Number(depth);
  }
  return {};
}

Cell QueueAge(const Process& process) {
  const auto seconds = Get(process, "queue_age_seconds");
  return seconds ? Number(*seconds * 1000, "{:.0f} ms") : Cell();
}

// Credit: records that may still be sent (actor), batches requested (learner), or requests for
// batches that wait for an answer (replay).
Cell Credit(const Process& process) {
  for (const char* name : {"credit", "requests_outstanding", "requests_waiting"}) {
    if (const auto credit = Get(process, name)) return Number(credit);
  }
  return {};
}

// Replay: the share of time in which the limiter blocked a side, and the side. Actor and learner:
// the share of time in which they waited.
Cell Blocked(const Process& process) {
  if (process.role == "replay") {
    const double in = Get(process, "limiter_blocked_insert_share").value_or(0);
    const double out = Get(process, "limiter_blocked_sample_share").value_or(0);
    return in >= out ? Share(in, " in") : Share(out, " out");
  }
  if (process.role == "actor") return Share(Get(process, "share_waiting_credit"));
  if (process.role == "learner") return Share(Get(process, "share_waiting_data"));
  return {};
}

// How the learner gets its batches.
Cell Batches(const Process& process) {
  const auto shared = Get(process, "batches_shared");
  return shared ? Text(*shared > 0 ? "memory" : "network") : Cell();
}

// The use of the learner's GPU: "41 %, 3.2 of 80 GB".
Cell Gpu(const Process& process) {
  const auto used = Get(process, "card_memory_mb"), size = Get(process, "card_memory_size_mb");
  if (!used || !size) return {};
  const auto busy = Get(process, "card_busy");
  const std::string share = busy ? fmt::format("{:.0f} %, ", 100 * *busy) : "";
  return {fmt::format("{}{:.1f} of {:.0f} GB", share, *used / 1000, *size / 1000), busy};
}

// The stage that took most of the last second.
Cell Busiest(const Process& process) {
  constexpr std::string_view kPrefix = "share_";
  Cell busiest;
  for (size_t i = 0; i < process.names.size() && i < process.values.size(); ++i) {
    const std::string_view name = process.names[i];
    if (!name.starts_with(kPrefix) || process.values[i] <= busiest.number.value_or(0)) continue;
    const std::string stage = WordsOf(std::string(name.substr(kPrefix.size())));
    busiest = {fmt::format("{} {:.0f} %", stage, 100 * process.values[i]), process.values[i]};
  }
  return busiest;
}

int RoleOrder(const std::string& role) {
  constexpr const char* kRoles[] = {"coordinator", "learner", "replay", "eval", "actor"};
  return static_cast<int>(std::ranges::find(kRoles, role) - std::begin(kRoles));
}

struct Column {
  const char* name;
  Cell (*cell)(const Process&);
  size_t least;  // least width; usual figures fit into it
  const char* meaning;
};

constexpr char kGpuColumn[] = "GPU";

constexpr Column kColumns[] = {
    {"PROCESS", [](const Process& p) { return Text(fmt::format("{}-{}", p.role, p.id)); }, 13,
     "role and number"},
    {"HOST", [](const Process& p) { return Text(p.host); }, 0, "host of the process"},
    {"PID", [](const Process& p) { return Number(p.pid); }, 0, "process id on that host"},
    {"STATE", [](const Process& p) { return Text(p.state); }, 10,
     "running, idle, ...; silent: not heard for 5 s"},
    {"RATE", Rate, 16, "env steps, updates or stored records per second"},
    {"CPU", [](const Process& p) { return Share(Get(p, "cpu_share")); }, 6,
     "CPU use in the last second, 100 % = one core"},
    {"QUEUE", Queue, 5, "waiting chunks, batches, or records not yet acknowledged"},
    {"AGE", QueueAge, 8, "age of the oldest entry of QUEUE"},
    {"CREDIT", Credit, 6, "records that may be sent, or requests without an answer"},
    {"BLOCKED", Blocked, 9, "share of the last second spent held (in, out) or waiting"},
    {"BATCHES", Batches, 7, "path of batches to the learner"},
    {kGpuColumn, Gpu, 0, "use and memory of the learner's GPU; only if it has one"},
    {"LAG 50/90/99", [](const Process& p) { return Quantiles(p, "policy_lag", "{:.0f}"); }, 12,
     "policy lag of stored records in updates, quantiles"},
    {"DATA AGE 50/90/99",
     [](const Process& p) { return Quantiles(p, "data_age_updates", "{:.0f}"); }, 17,
     "age of the learner's data in updates, quantiles"},
    {"DATA s 50/90/99", [](const Process& p) { return Quantiles(p, "data_age_seconds", "{:.1f}"); },
     17, "age of the sampled data in seconds, quantiles"},
    {"MB", [](const Process& p) { return Number(Get(p, "rss_mb")); }, 5, "resident memory"},
    {"FILES", [](const Process& p) { return Number(Get(p, "open_files")); }, 5, "open files"},
    {"MOST TIME IN", Busiest, 0, "stage that took most of the last second"},
};

using Row = std::vector<Cell>;

bool Before(const Row& a, const Row& b, size_t column) {
  const Cell &x = a[column], &y = b[column];
  if (x.number && y.number) return *x.number > *y.number;
  if (x.number || y.number) return x.number.has_value();
  return x.text < y.text;
}

std::vector<Row> SortedRows(const RunViewMessage& view, const TopOrder& order) {
  std::vector<const Process*> processes;
  for (const Process& process : view.processes) processes.push_back(&process);
  std::ranges::stable_sort(processes, [](const Process* a, const Process* b) {
    const int x = RoleOrder(a->role), y = RoleOrder(b->role);
    return x != y ? x < y : a->id < b->id;
  });
  std::vector<Row> rows;
  for (const Process* process : processes) {
    Row row;
    for (const Column& column : kColumns) row.push_back(column.cell(*process));
    rows.push_back(std::move(row));
  }
  const auto column = static_cast<size_t>(order.column);
  if (column > 0) {
    std::ranges::stable_sort(rows,
                             [&](const Row& a, const Row& b) { return Before(a, b, column); });
  }
  if (order.reversed) std::ranges::reverse(rows);
  return rows;
}

// A width of 0 leaves the column out.
std::string Rendered(const Row& row, const TopWidths& widths) {
  std::string line;
  for (size_t i = 0; i < row.size(); ++i) {
    // Aligns text to the left and numbers to the right; the last column has no padding.
    const bool number = row[i].number && i + 1 < row.size();
    if (widths[i] == 0) continue;
    if (i + 1 == row.size()) {
      line += row[i].text;
    } else if (number) {
      line += fmt::format("{:>{}}  ", row[i].text, widths[i]);
    } else {
      line += fmt::format("{:<{}}  ", row[i].text, widths[i]);
    }
  }
  return line;
}

Row Heading(const TopOrder& order) {
  Row heading;
  for (int i = 0; i < TopColumns(); ++i) {
    heading.push_back({TopColumnName(i) + (i == order.column ? "*" : "")});
  }
  return heading;
}

void Widen(const Row& row, TopWidths* widths) {
  for (size_t i = 0; i < row.size(); ++i)
    widths->at(i) = std::max(widths->at(i), row[i].text.size());
}

TopWidths LeastWidths() {
  TopWidths widths;
  for (const Column& column : kColumns) widths.push_back(column.least);
  return widths;
}

size_t ColumnOf(std::string_view name) {
  return static_cast<size_t>(std::ranges::find(kColumns, name, &Column::name) -
                             std::begin(kColumns));
}

bool HasGpu(const RunViewMessage& view) {
  return std::ranges::any_of(view.processes, [](const Process& process) {
    return Get(process, "card_memory_mb").has_value();
  });
}

// Sets widths of columns to 0 until a row fits, beginning with details that --json shows.
void LeaveOutColumns(size_t most, TopWidths* widths) {
  constexpr std::string_view kFirstToGo[] = {
      "FILES", "BATCHES",           kGpuColumn, "DATA s 50/90/99", "PID",
      "HOST",  "DATA AGE 50/90/99", "AGE",      "CREDIT",          "MB",
      "CPU",   "LAG 50/90/99",      "QUEUE"};
  const auto needed = [&] {
    size_t sum = widths->back();
    for (size_t i = 0; i + 1 < widths->size(); ++i) {
      if ((*widths)[i] > 0) sum += (*widths)[i] + 2;
    }
    return sum;
  };
  for (const std::string_view name : kFirstToGo) {
    if (needed() <= most) return;
    widths->at(ColumnOf(name)) = 0;
  }
}

}  // namespace

int TopColumns() { return static_cast<int>(std::size(kColumns)); }

std::string TopColumnName(int column) { return kColumns[column].name; }

std::vector<std::string> DescribeTopColumns() {
  std::vector<std::string> lines;
  for (const Column& column : kColumns) {
    lines.push_back(fmt::format("  {:<17}  {}", column.name, column.meaning));
  }
  return lines;
}

std::vector<std::string> FormatTop(const RunViewMessage& view, const TopOrder& order, int width,
                                   TopWidths* widths) {
  const size_t most = width > 0 ? static_cast<size_t>(width) : std::string::npos;
  std::vector<std::string> lines;
  for (const std::string& text : {FormatTopLine(view), AdviceOfView(view)}) {
    for (std::string& line : WrapToColumns(text, most, /*hanging=*/false)) {
      lines.push_back(std::move(line));
    }
  }
  const Row heading = Heading(order);
  const std::vector<Row> rows = SortedRows(view, order);
  TopWidths now = widths == nullptr || widths->empty() ? LeastWidths() : *widths;
  Widen(heading, &now);
  for (const Row& row : rows) Widen(row, &now);
  if (widths != nullptr) *widths = now;
  if (!HasGpu(view)) now[ColumnOf(kGpuColumn)] = 0;
  LeaveOutColumns(most, &now);
  lines.push_back(CutToColumns(Rendered(heading, now), most));
  for (const Row& row : rows) lines.push_back(CutToColumns(Rendered(row, now), most));
  return lines;
}

TopCells MakeTopCells(const RunViewMessage& view) {
  TopCells cells;
  for (const Column& column : kColumns) cells.columns.emplace_back(column.name);
  for (const Row& row : SortedRows(view, TopOrder())) {
    std::vector<std::string>& texts = cells.rows.emplace_back();
    for (const Cell& cell : row) texts.push_back(cell.text);
  }
  if (HasGpu(view)) return cells;
  const auto gpu = static_cast<std::ptrdiff_t>(ColumnOf(kGpuColumn));
  cells.columns.erase(cells.columns.begin() + gpu);
  for (std::vector<std::string>& texts : cells.rows) texts.erase(texts.begin() + gpu);
  return cells;
}

std::string FormatTopLine(const RunViewMessage& view) {
  return fmt::format("{}: {}", view.run, FormatProgressLine(FiguresOfView(view, Now())));
}

std::string TopJson(const RunViewMessage& view) {
  nlohmann::ordered_json processes = nlohmann::ordered_json::array();
  for (const Process& process : view.processes) {
    nlohmann::ordered_json object{{"role", process.role},   {"id", process.id},
                                  {"host", process.host},   {"pid", process.pid},
                                  {"state", process.state}, {"time", process.time}};
    for (size_t i = 0; i < process.names.size() && i < process.values.size(); ++i) {
      object[process.names[i]] = process.values[i];  // JSON has null for what is not finite
    }
    processes.push_back(std::move(object));
  }
  const nlohmann::ordered_json object{{"schema", view.schema},       {"run", view.run},
                                      {"time", view.time},           {"state", view.state},
                                      {"env_steps", view.env_steps}, {"updates", view.updates},
                                      {"processes", processes},      {"trouble", view.trouble}};
  // Names are received over the network: invalid UTF-8 in them is replaced.
  return object.dump(2, ' ', /*ensure_ascii=*/false,
                     nlohmann::ordered_json::error_handler_t::replace);
}

}  // namespace shoal::launch
