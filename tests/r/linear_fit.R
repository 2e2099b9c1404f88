# Copyright the Palmar authors.
# SPDX-License-Identifier: Apache-2.0
#
# Truth of src/palmar/statistics/linear_fit_test.cpp, made with R 4.2.2: Rscript linear_fit.R
out <- function(name, x) cat(name, ":", paste(sprintf("%.17g", x), collapse = ", "), "\n")
report <- function(name, fit, at) {
  cat("#", name, "\n")
  s <- summary(fit)
  for (k in seq_len(nrow(s$coefficients))) out(rownames(s$coefficients)[k], s$coefficients[k, ])
  f <- s$fstatistic
  out("r2 adjusted sigma F p", c(s$r.squared, s$adj.r.squared, s$sigma, f[1],
                                 pf(f[1], f[2], f[3], lower.tail = FALSE)))
  out("confidence", predict(fit, at, interval = "confidence", level = 0.95))
  out("prediction", predict(fit, at, interval = "prediction", level = 0.99))
}
# Braking distances (Ezekiel 1930; R's `cars`).
report("cars", lm(dist ~ speed, cars), data.frame(speed = 21))
# Two predictors that go together (Henderson & Velleman 1981; R's `mtcars`).
report("mtcars", lm(mpg ~ wt + hp, mtcars), data.frame(wt = 3, hp = 120))
# Longley 1967 (R's `longley`): six predictors, nearly a linear function of one another. NIST
# certifies these coefficients (StRD, Longley).
report("longley", lm(Employed ~ GNP.deflator + GNP + Unemployed + Armed.Forces + Population + Year, longley),
       data.frame(GNP.deflator = 100, GNP = 400, Unemployed = 300, Armed.Forces = 250, Population = 117, Year = 1955))
# A falling line, 200 points, p far out.
i <- 1:200
x <- 190 + 10 * sin(i)
y <- 260 - 0.31 * x + 2 * cos(i * 1.3)
report("negative", lm(y ~ x), data.frame(x = 240))
# The fewest.
d <- data.frame(x = c(1, 2, 4), y = c(1, 2, 2.5))
report("three", lm(y ~ x, d), data.frame(x = 3))
