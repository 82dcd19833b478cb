# Rscript tests/reference/posterior-diagnostics.R > tests/reference/posterior-diagnostics.json: draws and what R's posterior package says of them
suppressMessages(library(posterior))
set.seed(1)
n <- 60; m <- 4
ar <- function(phi, shift) { x <- numeric(n); x[1] <- rnorm(1); for (i in 2:n) x[i] <- phi * x[i-1] + rnorm(1); x + shift }
series <- list(
  independent = sapply(1:m, function(c) rnorm(n)),
  correlated = sapply(1:m, function(c) ar(0.7, 0)),
  antithetic = sapply(1:m, function(c) ar(-0.6, 0)),
  shifted = sapply(1:m, function(c) ar(0.3, if (c == 4) 1.5 else 0)),
  spread = sapply(1:m, function(c) rnorm(n, 0, c)),
  heavy = sapply(1:m, function(c) rt(n, 1)),
  ties = sapply(1:m, function(c) round(2 * ar(0.5, 0))),
  odd = sapply(1:m, function(c) ar(0.5, 0))[1:(n - 1), ])
f <- function(x) formatC(x, digits = 17, format = "g")
out <- lapply(names(series), function(name) { x <- series[[name]]
  sprintf('{"name": "%s", "iterations": %d, "chains": %d, "draws": [%s], "rhat": %s, "ess_bulk": %s, "ess_tail": %s, "ess_mean": %s, "mcse_mean": %s}',
    name, nrow(x), ncol(x), paste(f(as.vector(x)), collapse = ", "), f(rhat(x)), f(ess_bulk(x)), f(ess_tail(x)), f(ess_mean(x)), f(mcse_mean(x))) })
cat(sprintf('{"command": "Rscript tests/reference/posterior-diagnostics.R", "posterior": "%s", "note": "draws chain after chain", "cases": [\n%s\n]}\n',
    packageVersion("posterior"), paste(out, collapse = ",\n")))
