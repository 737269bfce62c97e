# Several random intercepts. lme4 stops near the optimum; here the slope of the restricted likelihood
# by the variances, with full matrices, is brought to zero to the last digits, and Satterthwaite's
# degrees of freedom are in closed form. lmerTest, given the model at that point, must agree to 1e-6
# in everything, and lmer's own optimum must not lie above that point.
source("reference.R")
suppressMessages({
  library(lme4)
  library(lmerTest)
})

# P = V^-1 less its part along X, and what the likelihood needs of it.
at <- function(variances, parts, x, y) {
  v <- Reduce(`+`, Map(`*`, variances, parts))
  inverse <- chol2inv(chol(v))
  covariance <- solve(crossprod(x, inverse %*% x))
  p <- inverse - inverse %*% x %*% covariance %*% crossprod(x, inverse)
  r <- drop(p %*% y)
  products <- lapply(parts, function(part) p %*% part)
  pull <- lapply(parts, function(part) drop(part %*% r))
  pairs <- function(f) outer(seq_along(parts), seq_along(parts), Vectorize(f))
  list(covariance = covariance, estimate = drop(covariance %*% crossprod(x, inverse %*% y)),
       slope = mapply(function(m, d) sum(diag(m)) - sum(r * d), products, pull),
       hessian = pairs(function(i, j) 2 * sum(pull[[i]] * (p %*% pull[[j]])) -
                         sum(products[[i]] * t(products[[j]]))),
       jacobian = lapply(parts, function(part) {
         w <- inverse %*% x %*% covariance
         crossprod(w, part %*% w)
       }),
       reml = (length(y) - ncol(x)) * log(2 * pi) + sum(y * r) +
         as.numeric(determinant(v)$modulus) - as.numeric(determinant(covariance)$modulus))
}

# Newton's method from lme4's optimum, over the variances that are not 0 there.
polished <- function(variances, parts, x, y) {
  positive <- variances > 0
  for (step in 1:8) {
    here <- at(variances[positive], parts[positive], x, y)
    variances[positive] <- variances[positive] - solve(here$hessian, here$slope)
  }
  all <- at(variances, parts, x, y)
  stopifnot(all(abs(all$slope[positive] * variances[positive]) < 1e-8),
            all(all$slope[!positive] >= 0), all(variances >= 0))
  list(variances = variances,
       at = at(variances[positive], parts[positive], x, y))
}

freedom <- function(weights, m) {
  slopes <- sapply(m$jacobian, function(j) sum(weights * (j %*% weights)))
  2 * sum(weights * (m$covariance %*% weights))^2 / sum(slopes * (2 * solve(m$hessian, slopes)))
}

joint <- function(contrasts, m) {
  e <- eigen(contrasts %*% m$covariance %*% t(contrasts), symmetric = TRUE)
  along <- crossprod(e$vectors, contrasts)
  df <- apply(along, 1, freedom, m)
  part <- sum(df / (df - 2))
  f <- mean(drop(along %*% m$estimate)^2 / e$values)
  ddf <- if (any(df <= 2)) 2 else 2 * part / (part - length(df))
  list(f = f, ddf = ddf, p = pf(f, length(df), ddf, lower.tail = FALSE))
}

agree <- function(theirs, ours) {
  stopifnot(all(abs(theirs / ours - 1) < 1e-6))
}

# terms: in the order in which the variances are answered. contrasts: rows tested together; the
# first two coefficients after the intercept are also held against each other.
model <- function(case, fixed, terms, data, contrasts = NULL, zero = 0) {
  data$response <- model.response(model.frame(fixed, data))
  formula <- update(fixed, as.formula(paste(". ~ . +", paste0("(1 | ", terms, ")", collapse = "+"))))
  fit <- suppressMessages(lme4::lmer(formula, data))
  structure <- lFormula(formula, data, REML = TRUE)
  z <- structure$reTrms$Ztlist[paste("1 |", terms)]
  parts <- c(lapply(z, function(t) as.matrix(crossprod(t))), list(diag(nrow(data))))
  theta <- getME(fit, "theta")[match(paste("1 |", terms), names(structure$reTrms$Ztlist))]
  theta[theta < 1e-3] <- 0
  best <- polished(unname(c(theta^2, 1) * sigma(fit)^2), parts, structure$X, data$response)
  stopifnot(sum(best$variances == 0) == zero, best$at$reml <= REMLcrit(fit) + 1e-9)
  m <- best$at
  error <- sqrt(diag(m$covariance))
  df <- apply(diag(length(error)), 1, freedom, m)
  k <- length(terms)
  difference <- c(0, 1, -1, rep(0, length(error) - 3))
  spread <- sqrt(sum(difference * (m$covariance %*% difference)))
  if (is.null(contrasts)) {
    contrasts <- t(lmerTest:::doolittle(crossprod(structure$X))$L)[-1, ]
  }
  f <- joint(contrasts, m)
  p <- 2 * pt(-abs(m$estimate / error), df)
  answer(case, estimate = m$estimate, error = error, df = df, t = m$estimate / error, p = p,
         variance = best$variances[1:k], within = best$variances[k + 1], reml = m$reml,
         difference = sum(difference * m$estimate), spread = spread,
         difference_df = freedom(difference, m), f = f$f, ddf = f$ddf, p_f = f$p)

  deviance <- do.call(mkLmerDevfun, structure)
  ratio <- sqrt(best$variances[1:k] / best$variances[k + 1])
  ratio <- ratio[match(names(structure$reTrms$Ztlist), paste("1 |", terms))]
  value <- deviance(ratio)
  there <- mkMerMod(environment(deviance), list(par = ratio, fval = value, conv = 0, message = ""),
                    structure$reTrms, structure$fr)
  theirs <- lmerTest:::as_lmerModLT(there, deviance)
  table <- coef(summary(theirs))
  agree(table[, "Estimate"], m$estimate)
  agree(table[, "Std. Error"], error)
  agree(table[, "df"], df)
  agree(table[, "t value"], m$estimate / error)
  agree(table[, "Pr(>|t|)"], p)
  agree(value, m$reml)
  agree(sigma(theirs)^2, best$variances[k + 1])
  agree(unlist(contest(theirs, difference, joint = FALSE)[c("Std. Error", "df")]),
        c(spread, freedom(difference, m)))
  agree(unlist(contest(theirs, contrasts)[c("F value", "DenDF", "Pr(>F)")]), c(f$f, f$ddf, f$p))
  if (length(attr(terms(fixed), "term.labels")) == 1) {
    agree(unlist(anova(theirs)["condition", c("F value", "DenDF", "Pr(>F)")]),
          c(f$f, f$ddf, f$p))
  }
}

procedure("Mixed model with several random terms", "lme4 lmer; lmerTest anova contest")
study <- subset(data_set("study"), trial <= 9)
study$row <- seq_len(nrow(study))
number <- as.integer(study$subject)
place <- as.integer(study$condition)
study$cell <- 3 * number + place
study$set <- 10 * study$cell + study$block
study$score <- study$score + 20 * ((3 * number + 5 * place + 2 * study$block) %% 11)
nested <- c("subject", "cell", "set")
model("balanced", score ~ condition, nested, study)
some <- subset(study, row %% 7 != 0 & !(subject == "P03" & trial > 5) &
                 !(subject == "P05" & condition == "visual"))
model("unbalanced", score ~ condition, nested, some)
two <- cbind(0, 0, 0, 0, diag(2))
model("two factors", score ~ condition * group, nested, some, two)
some$item <- some$row %% 13
some$score <- some$score + 30 * ((some$item * 5) %% 13)
model("crossed", score ~ condition + group, c("subject", "item"), some,
      rbind(c(0, 1, 0, 0), c(0, 0, 1, 0)))

# Variances at 0: a response in which groups differ less than by chance, and parts of it added.
study$even <- (study$row * 37) %% 53
model("all at 0", even ~ condition, nested, study, zero = 3)
study$people <- study$even + 5 * ((number * 5) %% 12)
model("two at 0", people ~ condition, nested, study, zero = 2)
study$cells <- study$people + 4 * ((number * 7 + 5 * place) %% 11)
model("one at 0", cells ~ condition, nested, study, zero = 1)
few <- subset(study, row %% 5 != 0 & !(subject == "P05" & condition == "visual"))
model("one at 0 unbalanced", cells ~ condition, nested, few, zero = 1)
finish()
