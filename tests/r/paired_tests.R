# Copyright the Palmar authors.
# SPDX-License-Identifier: Apache-2.0
#
# Truth of src/palmar/statistics/paired_test_test.cpp, made with R 4.2.2: Rscript paired_tests.R
out <- function(name, x) cat(name, ":", paste(sprintf("%.17g", x), collapse = ", "), "\n")

# Non-central t interval of Cohen's dz (no base function has it: root of pt in ncp).
dz_interval <- function(t, n, level = 0.95) {
  a <- (1 - level) / 2
  f <- function(p) uniroot(function(d) pt(t, n - 1, d) - p, c(t - 30, t + 30), tol = 1e-13)$root
  c(f(1 - a), f(a)) / sqrt(n)
}
report <- function(name, a, b) {
  cat("#", name, "\n")
  p <- t.test(a, b, paired = TRUE)
  out("t", c(p$estimate, p$conf.int, p$statistic, p$parameter, p$p.value))
  d <- a - b
  out("dz", c(mean(d) / sd(d), dz_interval(unname(p$statistic), length(d))))
  w <- suppressWarnings(wilcox.test(a, b, paired = TRUE, conf.int = TRUE))
  out("wilcoxon V p", c(w$statistic, w$p.value))
  cat(w$method, "\n")
  out("pseudomedian, interval", c(w$estimate, w$conf.int))
  v <- t.test(a, b)
  out("welch", c(v$statistic, v$parameter, v$p.value, v$conf.int))
}

# Student's sleep data (Student 1908; R's `sleep`): one zero difference, one tie.
report("sleep", sleep$extra[1:10], sleep$extra[11:20])
# Darwin's maize (Fisher 1935): 15 pairs, one tie of magnitude.
report("darwin", c(23.5, 12, 21, 22, 19.125, 21.5, 22.125, 20.375, 18.25, 21.625, 23.25, 21, 22.125, 23, 12),
       c(17.375, 20.375, 20, 20, 18.375, 18.625, 18.625, 15.25, 16.5, 18, 16.25, 18, 12.75, 15.5, 18))
# Hollander & Wolfe 1973, p. 29 (R's example of wilcox.test): exact, n = 9.
report("depression", c(1.83, 0.50, 1.62, 2.48, 1.68, 1.88, 1.55, 3.06, 1.30),
       c(0.878, 0.647, 0.598, 2.05, 1.06, 1.29, 1.06, 3.14, 1.29))
# n = 3: the smallest that a table allows.
report("three", c(1, 2.5, 4), c(0.5, 2.75, 3))
# Exact at the edge, n = 49; normal at n = 50; n = 200 with p about 1e-12 and below.
report("n49", sin(1:49) + 0.3, cos(1:49))
report("n50", sin(1:50) + 0.3, cos(1:50))
report("n200", 3700 + 80 * sin(1:200) + 20, 3700 + 80 * cos((1:200) * 1.7) - 30)
# Many ties and zeros: whole numbers.
report("ties", (1:60 * 7) %% 11, (1:60 * 5) %% 13)

cat("# holm\n")
out("holm", p.adjust(c(0.01, 0.04, 0.03, 0.005, 0.5, 0.04), "holm"))
