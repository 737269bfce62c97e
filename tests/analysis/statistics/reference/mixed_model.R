# lme4 stops near the optimum; here the score is brought to zero to the last digits, and lme4's model
# is taken at that point, which its own deviance must not put above its optimum. nlme must agree. Satterthwaite's degrees of freedom come from
# the closed form with the full covariance matrix, and lmerTest, whose derivatives are numerical,
# must agree to what those give.
source("reference.R")
suppressMessages({
  library(lme4)
  library(lmerTest)
  library(nlme)
})

# Of the restricted deviance by theta^2, the variance between by that within.
score <- function(theta, x, z, y) {
  count <- colSums(z)
  weighted <- function(a) a - z %*% (theta^2 / (1 + count * theta^2) * crossprod(z, a))
  a <- crossprod(x, weighted(x))
  r <- y - x %*% solve(a, crossprod(x, weighted(y)))
  within <- sum(r * weighted(r)) / (length(y) - ncol(x))
  u <- crossprod(z, weighted(x))
  sum(count / (1 + count * theta^2)) - sum(solve(a) * crossprod(u)) -
    sum(crossprod(z, weighted(r))^2) / within
}

polished <- function(formula, data) {
  parts <- lFormula(formula, data, REML = TRUE)
  deviance <- do.call(mkLmerDevfun, parts)
  theta <- optimize(deviance, c(0, 100), tol = 1e-8)$minimum
  if (deviance(0) <= deviance(theta)) theta <- 0
  if (theta > 0) {
    least <- deviance(theta)
    z <- t(as.matrix(parts$reTrms$Zt))
    theta <- uniroot(function(t) score(t, parts$X, z, model.response(parts$fr)),
                     theta * c(0.9, 1.1), tol = 1e-15)$root
    stopifnot(deviance(theta) <= least + 1e-9)
  }
  value <- deviance(theta)
  mkMerMod(environment(deviance), list(par = theta, fval = value, conv = 0, message = ""),
           parts$reTrms, parts$fr)
}

degrees <- function(fit) {
  x <- getME(fit, "X")
  z <- as.matrix(getME(fit, "Z"))
  theta <- getME(fit, "theta")
  n <- nrow(x)
  s <- sigma(fit)^2
  if (theta == 0) return(rep(n - ncol(x), ncol(x)))
  v <- s * diag(n) + s * theta^2 * tcrossprod(z)
  inverse <- solve(v)
  covariance <- solve(t(x) %*% inverse %*% x)
  p <- inverse - inverse %*% x %*% covariance %*% t(x) %*% inverse
  r <- p %*% getME(fit, "y")
  parts <- list(diag(n), tcrossprod(z))  # of V by the variances within and between
  weighted <- list(p, p %*% parts[[2]])
  hessian <- outer(1:2, 1:2, Vectorize(function(i, j) {
    2 * t(parts[[i]] %*% r) %*% p %*% (parts[[j]] %*% r) - sum(weighted[[i]] * t(weighted[[j]]))
  }))
  gradient <- sapply(parts, function(d) {
    diag(covariance %*% t(x) %*% inverse %*% d %*% inverse %*% x %*% covariance)
  })
  spread <- rowSums((gradient %*% solve(hessian / 2)) * gradient)
  2 * diag(covariance)^2 / spread
}

model <- function(case, fixed, group, data) {
  formula <- update(fixed, as.formula(paste(". ~ . + (1 |", group, ")")))
  fit <- polished(formula, data)
  b <- fixef(fit)
  error <- sqrt(diag(as.matrix(vcov(fit))))
  df <- degrees(fit)
  variances <- as.data.frame(VarCorr(fit))$vcov
  answer(case, estimate = b, error = error, df = df, p = 2 * pt(-abs(b / error), df),
         low = b + qt(0.025, df) * error, between = variances[1], within = variances[2],
         log_likelihood = as.numeric(logLik(fit)))

  theirs <- coef(summary(lmerTest::lmer(formula, data)))
  stopifnot(abs(theirs[, "df"] / df - 1) < 1e-3, abs(theirs[, "Std. Error"] / error - 1) < 1e-4)
  if (variances[1] > 0) {
    other <- lme(fixed, data, random = as.formula(paste("~ 1 |", group)))
    stopifnot(abs(fixef(other) - b) < 1e-5 * (1 + abs(b)),
              abs(other$sigma^2 / variances[2] - 1) < 1e-5,
              abs(logLik(other) - logLik(fit)) < 1e-6)
  }
}

procedure("Mixed model with random intercept", "lme4 lmer; nlme lme; lmerTest")
study <- subset(data_set("study"), trial <= 12)
model("study", score ~ condition + group, "subject", study)
study$missing <- seq_len(nrow(study)) %% 7 == 0 | study$subject == "P03" & study$trial > 5
model("unbalanced", score ~ condition * group + trial, "subject", subset(study, !missing))
model("means", score ~ 1, "subject", aggregate(score ~ subject + condition, study, mean))
model("times", value ~ condition + group, "subject", data_set("times"))
times <- data_set("times")
times$even <- (seq_len(nrow(times)) * 37) %% 53  # participants differ less than by chance
model("boundary", even ~ condition, "subject", times)
finish()
