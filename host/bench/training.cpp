#include "host/bench/training.hpp"

#include <Eigen/Dense>
#include <cmath>
#include <numbers>
#include <vector>

#include "host/simulation/noise.hpp"

namespace strainfinger::bench {
namespace {

constexpr int kBatch = 64;
constexpr double kTrainingNoise = 0.003;  ///< between the levels that are scored

/// One layer with what Adam remembers of it. The bias is the last column.
struct Learner {
  Eigen::MatrixXf weight, mean, square;

  Learner(Eigen::Index outputs, Eigen::Index inputs, const simulation::Noise& noise, std::uint64_t first)
      : weight(Eigen::MatrixXf::Zero(outputs, inputs + 1)), mean(weight), square(weight) {
    const double spread = std::sqrt(2.0 / static_cast<double>(inputs));  // He et al. 2015
    for (Eigen::Index i = 0; i < weight.rows() * inputs; ++i)
      weight.data()[i] = static_cast<float>(spread * noise.at(first + static_cast<std::uint64_t>(i), 0));
  }

  Eigen::MatrixXf forward(const Eigen::MatrixXf& input) const {
    return (weight.leftCols(input.rows()) * input).colwise() + weight.col(input.rows());
  }
  Eigen::MatrixXf backward(const Eigen::MatrixXf& slope) const {
    return weight.leftCols(weight.cols() - 1).transpose() * slope;
  }
  void learn(const Eigen::MatrixXf& slope, const Eigen::MatrixXf& input, int step, float rate) {
    constexpr float kMeanDecay = 0.9f, kSquareDecay = 0.999f, kFloor = 1e-8f;  // the paper's
    Eigen::MatrixXf gradient(weight.rows(), weight.cols());
    gradient << slope * input.transpose(), slope.rowwise().sum();
    mean = kMeanDecay * mean + (1 - kMeanDecay) * gradient;
    square = kSquareDecay * square + (1 - kSquareDecay) * gradient.cwiseAbs2();
    const float meanScale = 1 / (1 - std::pow(kMeanDecay, static_cast<float>(step)));
    const float squareScale = 1 / (1 - std::pow(kSquareDecay, static_cast<float>(step)));
    weight.array() -= rate * meanScale * mean.array() / ((squareScale * square.array()).sqrt() + kFloor);
  }
  template <std::size_t Inputs, std::size_t Outputs>
  void writeTo(Layer<Inputs, Outputs>& layer) const {
    for (std::size_t i = 0; i < Outputs; ++i) {
      const auto row = weight.row(static_cast<Eigen::Index>(i));
      for (std::size_t j = 0; j < Inputs; ++j) layer.weight[i][j] = row[static_cast<Eigen::Index>(j)];
      layer.bias[i] = row[Inputs];
    }
  }
};

struct Lessons {
  Eigen::MatrixXf question, answer;  // a column each
};

Lessons drawLessons(const BenchFinger& finger, std::uint64_t seed, int count) {
  Lessons lessons{{kWindow, count}, {3, count}};
  for (int i = 0; i < count; ++i) {
    const Reading reading = readingOf(finger, seed, static_cast<std::uint64_t>(i), kTrainingNoise);
    const int middle = sharpestGauge(reading.sample.strain);
    const Window<float> window = windowAbout(reading.sample.strain, middle);
    const float scale = Perceptron::scaleOf(window);
    const double load = double{scale} * double{Perceptron::kLoadPerStrain};
    lessons.question.col(i) = Eigen::Map<const Eigen::VectorXf>(window.data(), kWindow) / scale;
    lessons.answer.col(i) = Eigen::Vector3d(std::remainder(reading.truth.position_pitch - middle, kGauges),
                                            reading.truth.normal / load, reading.truth.tangential / load)
                                .cast<float>();
  }
  return lessons;
}

Eigen::MatrixXf bent(const Eigen::MatrixXf& values) {
  return (values.array() < 0).select(Perceptron::kLeak * values, values);
}
Eigen::MatrixXf bentSlope(const Eigen::MatrixXf& values, const Eigen::MatrixXf& slope) {
  return (values.array() < 0).select(Perceptron::kLeak * slope, slope);
}

class Pupil {
 public:
  explicit Pupil(std::uint64_t seed) : noise_(seed) {}

  void study(const Eigen::MatrixXf& question, const Eigen::MatrixXf& answer, int step, float rate) {
    const Eigen::MatrixXf one = first_.forward(question), oneBent = bent(one);
    const Eigen::MatrixXf two = second_.forward(oneBent), twoBent = bent(two);
    const Eigen::MatrixXf error = (last_.forward(twoBent) - answer) / static_cast<float>(question.cols());
    const Eigen::MatrixXf twoSlope = bentSlope(two, last_.backward(error));
    const Eigen::MatrixXf oneSlope = bentSlope(one, second_.backward(twoSlope));
    last_.learn(error, twoBent, step, rate);
    second_.learn(twoSlope, oneBent, step, rate);
    first_.learn(oneSlope, question, step, rate);
  }
  Perceptron perceptron() const {
    Perceptron result{};
    first_.writeTo(result.first);
    second_.writeTo(result.second);
    last_.writeTo(result.last);
    return result;
  }

 private:
  simulation::Noise noise_;
  Learner first_{Perceptron::kHidden, kWindow, noise_, 0};
  Learner second_{Perceptron::kHidden, Perceptron::kHidden, noise_, 10'000};
  Learner last_{3, Perceptron::kHidden, noise_, 20'000};
};

}  // namespace

Perceptron trainedPerceptron(const BenchFinger& finger, const Training& training) {
  constexpr double kRate = 4e-3;
  const Lessons lessons = drawLessons(finger, training.seed, training.contacts);
  Pupil pupil(training.seed);
  for (int step = 0; step < training.steps; ++step) {
    const double rate = kRate / 2 * (1 + std::cos(std::numbers::pi * step / training.steps));
    const Eigen::Index from = Eigen::Index{step} * kBatch % training.contacts;
    pupil.study(lessons.question.middleCols(from, kBatch), lessons.answer.middleCols(from, kBatch), step + 1,
                static_cast<float>(rate));
  }
  return pupil.perceptron();
}

}  // namespace strainfinger::bench
