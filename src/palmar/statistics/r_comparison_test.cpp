// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <random>
#include <sstream>

#include "palmar/statistics/correlation.h"
#include "palmar/statistics/linear_fit.h"
#include "palmar/statistics/paired_test.h"
#include "palmar/statistics/statistics_test_data.h"

namespace palmar::statistics {
namespace {

/// What R prints; "" if it isn't installed.
std::string r_output(const std::string& code) {
  const auto path =
      std::filesystem::temp_directory_path() / ("palmar-r-" + std::to_string(::getpid()) + ".R");
  std::ofstream(path) << code;
  std::string output;
  std::FILE* pipe = ::popen(("Rscript --vanilla " + path.string() + " 2>/dev/null").c_str(), "r");
  if (pipe != nullptr) {
    char buffer[4096];
    while (const std::size_t n = std::fread(buffer, 1, sizeof buffer, pipe))
      output.append(buffer, n);
    ::pclose(pipe);
  }
  std::filesystem::remove(path);
  return output;
}

std::string r_vector(const char* name, const std::vector<double>& values) {
  std::ostringstream text;
  text.precision(17);
  text << name << " <- c(";
  for (std::size_t i = 0; i < values.size(); ++i) text << (i > 0 ? "," : "") << values[i];
  text << ")\n";
  return text.str();
}

// Thirty random data sets of 3 to 120 pairs, every third rounded so that ties and zeros come up.
TEST(Statistics, EqualRWhereItIsInstalled) {
  std::mt19937_64 random(11);
  std::normal_distribution<double> normal;
  std::string code =
      "options(digits = 17, warn = -1)\n"
      "out <- function(x) cat(sprintf('%.17g', x), sep = '\\n')\n";
  std::vector<std::pair<std::vector<double>, std::vector<double>>> data;
  for (int k = 0; k < 30; ++k) {
    const std::size_t n = k < 5 ? 3U + static_cast<std::size_t>(k) : 3 + random() % 118;
    std::vector<double> x, y;
    for (std::size_t i = 0; i < n; ++i) {
      const double common = normal(random);
      x.push_back(190 + 10 * common);
      y.push_back(189 + 6 * common * (k % 2 == 0 ? 1 : -1) + 8 * normal(random));
      if (k % 3 == 0) {
        x.back() = std::round(x.back());
        y.back() = std::round(y.back());
      }
    }
    data.emplace_back(x, y);
    code += r_vector("x", x) + r_vector("y", y) +
            "p <- t.test(x, y, paired = TRUE); out(c(p$statistic, p$p.value, p$conf.int))\n"
            "w <- wilcox.test(x, y, paired = TRUE); out(c(w$statistic, w$p.value))\n"
            "v <- t.test(x, y); out(c(v$statistic, v$parameter, v$p.value))\n"
            "r <- cor.test(x, y); out(c(r$estimate, r$p.value))\n"
            "s <- cor.test(x, y, method = 'spearman', exact = length(x) <= 9 && "
            "!any(duplicated(x), duplicated(y))); out(c(s$estimate, s$p.value))\n"
            "f <- summary(lm(y ~ x)); out(c(f$coefficients, f$r.squared, f$sigma))\n"
            "out(predict(lm(y ~ x), data.frame(x = 205), interval = 'prediction', level = 0.9))\n";
  }
  std::istringstream output(r_output(code));
  double first = 0.0;
  if (!(output >> first)) GTEST_SKIP() << "Rscript isn't installed (Debian: r-base-core)";
  output.seekg(0);
  int figures = 0;
  const auto check = [&](double ours, const char* what) {
    std::string word;
    ASSERT_TRUE(output >> word) << what;
    const double theirs = std::stod(word);
    // Above 0 where R's figure is a difference of larger ones.
    EXPECT_NEAR(ours, theirs, 1e-9 * std::abs(theirs) + 1e-11) << what;
    ++figures;
  };
  for (const auto& [x, y] : data) {
    const PairedTest p = paired_t_test(x, y);
    for (const double v : {p.t, p.p_value, p.interval.low, p.interval.high}) check(v, "t.test");
    const SignedRankTest w = wilcoxon_signed_rank(x, y);
    check(w.v, "V");
    check(w.p_value, "wilcox.test");
    const WelchTest u = welch_t_test(x, y);
    for (const double v : {u.t, u.df, u.p_value}) check(v, "Welch");
    const Correlation r = pearson(x, y);
    check(r.r, "r");
    check(r.p_value, "cor.test");
    const Correlation s = spearman(x, y);
    check(s.r, "rho");
    check(s.p_value, "spearman");
    const LinearFit fit = fit_line(x, y);
    const Coefficient& a = fit.intercept;
    const Coefficient& b = fit.slopes[0];
    for (const double v : {a.estimate, b.estimate, a.standard_error, b.standard_error, a.t, b.t,
                           a.p_value, b.p_value, fit.r2, fit.residual_sd}) {
      check(v, "lm");
    }
    const Band band = prediction_band(fit, 205.0, 0.9);
    for (const double v : {band.value, band.low, band.high}) check(v, "predict");
  }
  EXPECT_EQ(figures, 30 * 26);
}

}  // namespace
}  // namespace palmar::statistics
