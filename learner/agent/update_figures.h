// SPDX-License-Identifier: Apache-2.0
// Figures: the metrics of an update, as an ordered list of names and values.
//
// Each figure is declared once, with its meaning: in an algorithm's folder if only this algorithm
// computes the figure, otherwise here. Metrics, TensorBoard, Prometheus, the progress display and
// the documentation use the name and the meaning of this declaration (AllFigures in algorithms.h).
// If a figure was not computed, it is absent from the list, and not 0.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace shoal::learner {

struct Figure {
  std::string_view name;     // in metrics.jsonl and, as shoal_NAME, in Prometheus
  std::string_view unit;     // empty: a plain number
  std::string_view meaning;  // one line
  bool headline = false;     // whether the progress display shows the figure
  // Determines the figure's tag in TensorBoard. A text with a slash is the whole tag; a text
  // without a slash gives train/KNOWN_AS; an empty text gives train/NAME. If other programs have
  // the same figure, the tag is the same as in those programs.
  std::string_view known_as;

  std::string Tag() const;
};

class UpdateFigures {
 public:
  struct Entry {
    const Figure* figure;
    double value;
  };

  // Appends the figure, which must live until the program ends and must not be in the list yet.
  void Set(const Figure& figure, double value);
  // Replaces the figure's value, or appends the figure.
  void Replace(const Figure& figure, double value);
  std::optional<double> Get(const Figure& figure) const;

  const std::vector<Entry>& entries() const { return entries_; }
  bool empty() const { return entries_.empty(); }

 private:
  Entry* Find(const Figure& figure);

  std::vector<Entry> entries_;
};

// Figures that several algorithms compute. All of them are means over the batch of an update.
inline constexpr Figure kCriticLoss{.name = "critic_loss",
                                    .unit = "",
                                    .meaning = "squared error of all Q, summed over the critics",
                                    .headline = true,
                                    .known_as = ""};
inline constexpr Figure kActorLoss{.name = "actor_loss",
                                   .unit = "",
                                   .meaning = "loss of the policy",
                                   .headline = true,
                                   .known_as = ""};
inline constexpr Figure kQMean{"q_mean", "", "mean Q, the predicted scaled return", false, ""};
inline constexpr Figure kTargetMean{"target_mean", "", "mean target of Q", false, ""};
inline constexpr Figure kLearningRate{
    "learning_rate", "", "learning rate in force; of several, the critic's", false, ""};
inline constexpr Figure kActionSaturation{"action_saturation", "",
                                          "share of action components beyond 0.99", false, ""};
inline constexpr Figure kCriticGradNorm{"critic_grad_norm", "", "norm of the critic's gradient",
                                        false, ""};
inline constexpr Figure kActorGradNorm{"actor_grad_norm", "", "norm of the actor's gradient", false,
                                       ""};
inline constexpr Figure kTemperature{.name = "temperature",
                                     .unit = "",
                                     .meaning = "weight of the policy's entropy",
                                     .headline = true,
                                     .known_as = "ent_coef"};
inline constexpr Figure kEntropy{"entropy", "nats", "entropy of the policy", false, ""};

}  // namespace shoal::learner
