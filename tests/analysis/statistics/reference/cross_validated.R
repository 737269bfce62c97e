source("reference.R")

# Ridge by its normal equations, leaving out one subject after the other, lambda by leaving out one
# of the others after the other.
ridge <- function(x, y, lambda) {
  mean <- colMeans(x)
  scale <- apply(x, 2, sd)
  z <- scale(x, mean, scale)
  b <- solve(crossprod(z) + nrow(z) * lambda * diag(ncol(z)), crossprod(z, y - mean(y)))
  list(slopes = b, predict = function(new) mean(y) + scale(new, mean, scale) %*% b)
}
without <- function(x, y, who, out, lambda) {
  use <- !(who %in% out)
  ridge(x[use, , drop = FALSE], y[use], lambda)
}
best <- function(x, y, who, out, lambdas) {
  left <- setdiff(unique(who), out)
  errors <- sapply(lambdas, function(l) sum(sapply(left, function(s) {
    at <- who == s
    sum((y[at] - without(x, y, who, c(out, s), l)$predict(x[at, , drop = FALSE]))^2)
  })))
  lambdas[which.min(errors)]
}

procedure("Cross-validated ridge regression", "solve(crossprod(z) + n lambda I)")
study <- data_set("study")
who <- as.character(study$subject)
x <- cbind(study$trial, study$trial^2, study$condition == "visual",
           study$condition == "visuohaptic", study$group == "novice", study$block)
y <- study$score
lambdas <- 10^(-6:9 / 3)
predicted <- numeric(length(y))
chosen <- numeric()
means <- numeric(length(y))
for (s in unique(who)) {
  at <- who == s
  chosen[s] <- best(x, y, who, s, lambdas)
  predicted[at] <- without(x, y, who, s, chosen[s])$predict(x[at, ])
  means[at] <- mean(y[!at])
}
all <- best(x, y, who, character(), lambdas)
fit <- ridge(x, y, all)
answer("study", lambda = all, lambdas = chosen, slopes = fit$slopes, r = cor(predicted, y),
       rmse = sqrt(mean((predicted - y)^2)), r_resubstitution = cor(fit$predict(x), y),
       rmse_resubstitution = sqrt(mean((fit$predict(x) - y)^2)),
       gain = 1 - sum((y - predicted)^2) / sum((y - means)^2))
finish()
