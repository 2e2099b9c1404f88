# Copyright the Palmar authors.
# SPDX-License-Identifier: Apache-2.0
#
# Truth of src/palmar/statistics/correlation_test.cpp, made with R 4.2.2: Rscript correlation.R
out <- function(name, x) cat(name, ":", paste(sprintf("%.17g", x), collapse = ", "), "\n")
report <- function(name, x, y) {
  cat("#", name, "\n")
  p <- cor.test(x, y)
  out("pearson r t df p interval", c(p$estimate, p$statistic, p$parameter, p$p.value, p$conf.int))
  s <- suppressWarnings(cor.test(x, y, method = "spearman", exact = length(x) <= 9 && !any(duplicated(x), duplicated(y))))
  out("spearman rho p", c(s$estimate, s$p.value))
}
# Anscombe 1973, first set.
report("anscombe", anscombe$x1, anscombe$y1)
# Seven people, no ties: Spearman exact.
report("seven", c(181, 193, 176, 188, 201, 169, 184), c(190, 201, 187, 186, 209, 178, 198))
# Negative, 200 pairs, far tail.
i <- 1:200
report("negative", 190 + 10 * sin(i), 200 - 6 * sin(i) + 8 * cos(i * 1.3))
# Whole millimetres: ties in both.
report("ties", 180 + (i[1:60] * 7) %% 23, 195 + ((i[1:60] * 7) %% 23) %/% 2 + (i[1:60] * 5) %% 11)
# Four pairs: the fewest with an interval.
report("four", c(1, 2, 3, 5), c(2, 1, 4, 3.5))
