# The closed-form posteriors of sampler.cpp by rstan's NUTS, measured alike: Rscript sampler.R [REPEATS]
suppressMessages(library(rstan))
repeats <- as.integer(c(commandArgs(TRUE), "10")[1])
code <- "
data { int<lower=1> n; vector[n] w; vector[n] y; int<lower=0,upper=1> meter; }
parameters {
  real<lower=0.1, upper=0.8> mu;
  real<lower=0, upper=10> H;
  vector[2 * meter] unknown;   // offset / 0.05, log noise factor / 0.5
}
model {
  real offset = 0;
  real sigma = 0.02;
  if (meter) {
    unknown ~ std_normal();
    offset = 0.05 * unknown[1];
    sigma = 0.02 * exp(0.5 * unknown[2]);
  }
  y ~ normal(1 + 2 * mu * (1 + 0.5 * log1p(H / 2)) - 0.3 * H * w / (1 + H) + 0.4 * w .* w + offset, sigma);
}"
model <- stan_model(model_code = code, boost_lib = "/usr/include")  # where Debian keeps it
i <- 0:9
w <- i / 9
y <- 1 + 0.8 * (1 + 0.5 * log1p(2)) - 0.3 * 4 * w / 5 + 0.4 * w^2 + 0.02 * sin(3 * i + 1) * sqrt(2)
run <- function(meter, seed, iterations) {
  data <- list(n = 10, w = w, y = y, meter = meter)
  fit <- NULL
  cpu <- function(expression) sum(system.time(expression)[c("user.self", "sys.self", "user.child", "sys.child")])
  sampled <- cpu(fit <- sampling(model, data = data, chains = 4, iter = iterations, seed = seed, refresh = 0, cores = 1))
  judged <- cpu(monitor(as.array(fit), print = FALSE, warmup = 0))   # R-hat and effective sample sizes
  draws <- as.matrix(fit)
  list(draws = draws[, colnames(draws) != "lp__"], seconds = c(sum(get_elapsed_time(fit)), sampled, sampled + judged))
}
for (meter in 0:1) {
  long <- run(meter, 999, 20000)$draws
  truth <- colMeans(long)
  square <- 0
  seconds <- 0
  for (seed in 1:repeats) {
    one <- run(meter, seed, 2000)
    square <- square + (colMeans(one$draws) - truth)^2
    seconds <- seconds + one$seconds
  }
  effective <- min(apply(long, 2, var) / (square / repeats))
  each <- seconds / repeats  # Stan's own loops; sampling() as called from R; R-hat and effective sample sizes, too
  cat(sprintf("%-18s %6.0f effective draws per second of Stan's loops, %.0f of sampling(), %.0f with diagnostics (%.0f a run); means %s\n",
              if (meter) "rstan, 4 unknowns" else "rstan, 2 unknowns", effective / each[1], effective / each[2],
              effective / each[3], effective, paste(signif(truth[1:2], 4), collapse = " ")))
}
