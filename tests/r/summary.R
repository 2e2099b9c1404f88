# Copyright the Palmar authors.
# SPDX-License-Identifier: Apache-2.0
#
# Truth of src/palmar/statistics/summary_test.cpp, made with R 4.2.2: Rscript summary.R
out <- function(name, x) cat(name, ":", paste(sprintf("%.17g", x), collapse = ", "), "\n")
# G1 and G2 of Joanes & Gill 1998; base R has no function for them.
skewness <- function(x) { n <- length(x); m <- function(k) mean((x - mean(x))^k)
  sqrt(n * (n - 1)) / (n - 2) * m(3) / m(2)^1.5 }
kurtosis <- function(x) { n <- length(x); m <- function(k) mean((x - mean(x))^k)
  (n - 1) / ((n - 2) * (n - 3)) * ((n + 1) * (m(4) / m(2)^2 - 3) + 6) }
for (name in c("speed", "dist")) {
  x <- cars[[name]]
  out(name, c(mean(x), sd(x), sd(x) / sqrt(length(x)), t.test(x)$conf.int, quantile(x, c(0, .25, .5, .75, 1)),
              skewness(x), kurtosis(x)))
  out("99 % interval", t.test(x, conf.level = 0.99)$conf.int)
  out("percentiles", quantile(x, c(1, 5, 95, 99) / 100))
}
